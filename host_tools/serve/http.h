// http.h - the HTTP surface of `traction serve`: the page, its events, its requests.
//
//   GET  /                the page                  GET  /events          server-sent events (Workshop::events)
//   GET  /api/effects     the catalogue             GET  /api/result/ID   a result, as --json wrote it
//   GET  /api/rover       words of faults and modes GET  /api/scene       the code that draws a drive, as text
//   POST /api/run         order.h                   POST /api/cancel, /api/seal   { "id": N }
//
// Every request: the token (query "token", or header X-Traction-Token), a Host that is this machine's own name at this port (DNS
// rebinding), and, where a browser names one, an Origin and Sec-Fetch-Site of this page. Bodies: JSON of 64 kB at most. Answers forbid
// everything that the page does not need (Content-Security-Policy) and are never kept.
#pragma once

#include "workshop.h"

#include <memory>
#include <stdexcept>
#include <string>

namespace traction::serve {

// The port cannot be had: which, why, the mend.
struct PortError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Server {
  public:
    // Binds 127.0.0.1. port 0: one that is free. Throws PortError.
    Server(Workshop &workshop, int port, std::string token);
    ~Server();
    Server(const Server &) = delete;
    Server &operator=(const Server &) = delete;

    int port() const;
    std::string address() const; // with the token
    void listen();               // until stop()
    void stop();                 // from another thread; also ends the workshop

  private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

} // namespace traction::serve
