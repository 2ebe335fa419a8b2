#include "http.h"

#include "live_page.h"
#include "token.h"

#include "firmware/core/fault_name.h"
#include "firmware/core/signals.h"
#include "host_tools/drive/words.h"
#include "host_tools/lab/result/effects_json.h"
#include "host_tools/report/effect_drawing.h"
#include "host_tools/report/page.h"
#include "sim/physics/effects/catalogue.h"

#include <cstdint>
#include <httplib.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace traction::serve {

using nlohmann::json;

namespace {

constexpr const char *loopback = "127.0.0.1";
constexpr int most_listeners = 16; // browsers at once, each of which holds a thread
constexpr int threads = most_listeners + 8;
constexpr std::size_t most_body = 65536;

// A body by its length. The library compresses whatever text is set whole, which costs seconds of a processor where brotli is there, and
// saves nothing on a way that does not leave the machine.
void plain(httplib::Response &response, std::string text, const char *type) {
    if (text.empty()) return response.set_content("", type);
    const std::size_t size = text.size();
    response.set_content_provider(size, type, [text = std::move(text)](std::size_t from, std::size_t length, httplib::DataSink &sink) {
        return sink.write(text.data() + from, length);
    });
}

void answer(httplib::Response &response, int status, const json &body) {
    response.status = status;
    plain(response, body.dump(-1, ' ', false, json::error_handler_t::replace) + "\n", "application/json");
}

void refuse(httplib::Response &response, int status, const std::string &why) { answer(response, status, {{"error", why}}); }

// Why this port cannot be had, by asking the system again.
std::string why_not(int port) {
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return std::strerror(errno);
    const int yes = 1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, loopback, &address.sin_addr);
    int error = bind(fd, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0 ? 0 : errno;
    if (error == 0 && ::listen(fd, 1) != 0) error = errno;
    close(fd);
    return error == 0 ? "it was in use a moment ago" : std::strerror(error);
}

// The page with a fresh nonce in each of its places.
std::string page_with(const std::string &nonce) {
    const std::string_view page = live_page(), mark = "__TRACTION_NONCE__";
    std::string out;
    std::size_t from = 0;
    for (std::size_t at; (at = page.find(mark, from)) != std::string_view::npos; from = at + mark.size()) {
        out += page.substr(from, at - from);
        out += nonce;
    }
    return out += page.substr(from);
}

} // namespace

struct Server::Inside {
    Inside(Workshop &shared, std::string secret) : workshop(shared), token(std::move(secret)) {}
    Workshop &workshop;
    std::string token;
    int port = 0;
    httplib::Server server;
    std::atomic<int> listeners{0};
    std::atomic<bool> over{false};

    bool ours(const std::string &host) const {
        for (const char *name : {"127.0.0.1", "localhost"})
            if (host == std::string(name) + ":" + std::to_string(port)) return true;
        return false;
    }

    // Empty: may pass. Otherwise why not, with the status.
    std::pair<int, std::string> judge(const httplib::Request &request) const {
        if (request.get_header_value_count("Host") != 1 || !ours(request.get_header_value("Host")))
            return {403, "this server answers to 127.0.0.1 and localhost alone"};
        if (request.has_header("Origin") &&
            (request.get_header_value("Origin").rfind("http://", 0) != 0 || !ours(request.get_header_value("Origin").substr(7))))
            return {403, "the request comes from another page"};
        const std::string site = request.get_header_value("Sec-Fetch-Site");
        if (!site.empty() && site != "same-origin" && site != "none") return {403, "the request comes from another page"};
        const std::string given =
            request.has_header("X-Traction-Token") ? request.get_header_value("X-Traction-Token") : request.get_param_value("token");
        if (!same_token(token, given)) return {403, "the token is missing or wrong: open the address that `traction serve` printed"};
        if (request.method != "GET" && request.method != "POST") return {405, "GET and POST alone"};
        if (request.method == "POST" && request.get_header_value("Content-Type") != "application/json")
            return {415, "the body must be application/json"};
        return {0, ""};
    }

    void page(httplib::Response &response) const {
        const std::string nonce = make_token();
        response.set_header("Content-Security-Policy",
                            "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
                                "'; connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
        plain(response, page_with(nonce), "text/html; charset=utf-8");
    }

    void events(httplib::Response &response) {
        if (listeners.fetch_add(1) >= most_listeners) {
            --listeners;
            refuse(response, 503, "too many pages are open: close one");
            return;
        }
        auto seen = std::make_shared<Workshop::Seen>();
        auto begun = std::make_shared<bool>(false);
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, seen, begun](std::size_t, httplib::DataSink &sink) {
                if (over || workshop.stopped()) return false;
                std::string text = std::exchange(*begun, true) ? "" : "retry: 1000\n\n";
                text += workshop.events(*seen, std::chrono::milliseconds(2000));
                if (over || workshop.stopped()) return false;
                if (text.empty()) text = ": alive\n\n"; // a page that went away is noticed by this
                return sink.write(text.data(), text.size());
            },
            [this](bool) { --listeners; });
    }

    template <typename Work> void posted(const httplib::Request &request, httplib::Response &response, const Work &work) {
        const json body = json::parse(request.body, nullptr, false);
        if (body.is_discarded()) return refuse(response, 400, "the body is no JSON");
        try {
            answer(response, 200, work(body));
        } catch (const BadRequest &error) {
            refuse(response, 400, error.what());
        } catch (const Busy &error) {
            refuse(response, 409, error.what());
        } catch (const std::exception &error) {
            refuse(response, 500, error.what());
        }
    }

    static int id_of(const json &body) {
        if (!body.is_object() || !body.contains("id") || !body["id"].is_number_integer() || body["id"] < 1 || body["id"] > 1000000000)
            throw BadRequest("id: must be the number of a run");
        return body["id"].get<int>();
    }

    void routes() {
        server.set_pre_routing_handler([this](const httplib::Request &request, httplib::Response &response) {
            const auto [status, why] = judge(request);
            if (status == 0) return httplib::Server::HandlerResponse::Unhandled;
            refuse(response, status, why);
            return httplib::Server::HandlerResponse::Handled;
        });
        server.Get("/", [this](const httplib::Request &, httplib::Response &response) { page(response); });
        server.Get("/events", [this](const httplib::Request &, httplib::Response &response) { events(response); });
        server.Get("/api/effects", [](const httplib::Request &, httplib::Response &response) {
            json all = json::array();
            for (const sim::Effect &effect : sim::catalogue()) {
                all.push_back(lab::effect_json(effect));
                all.back()["drawing"] = report::effect_svg(effect, false);
            }
            answer(response, 200, all);
        });
        server.Get("/api/rover", [](const httplib::Request &, httplib::Response &response) {
            json words = {{"faults", json::array()}, {"modes", json::array()}, {"bridges", json::array()}};
            for (int i = 0; i < FAULT_COUNT; ++i) words["faults"].push_back(fault_name(i));
            for (int i = 0; i < MODE_COUNT; ++i) words["modes"].push_back(drive::mode_words(i));
            for (int i = DRIVE_OFF; i <= DRIVE_ON; ++i) words["bridges"].push_back(drive::bridge_words(i));
            answer(response, 200, words);
        });
        server.Get("/api/scene", [](const httplib::Request &, httplib::Response &response) {
            plain(response, std::string(report::scene_code()), "text/plain; charset=utf-8");
        });
        server.Get(R"(/api/result/([1-9][0-9]{0,8}))", [this](const httplib::Request &request, httplib::Response &response) {
            const auto text = workshop.result(std::atoi(request.matches[1].str().c_str()));
            if (!text) return refuse(response, 404, "there is no such result");
            plain(response, *text, "application/json");
        });
        server.Post("/api/run", [this](const httplib::Request &request, httplib::Response &response) {
            posted(request, response, [this](const json &body) { return json{{"id", workshop.run(body)}}; });
        });
        server.Post("/api/cancel", [this](const httplib::Request &request, httplib::Response &response) {
            posted(request, response, [this](const json &body) {
                workshop.cancel(id_of(body));
                return json{{"id", body["id"]}};
            });
        });
        server.Post("/api/seal", [this](const httplib::Request &request, httplib::Response &response) {
            posted(request, response, [this](const json &body) {
                workshop.open_seal(id_of(body));
                return json{{"id", body["id"]}};
            });
        });
        server.set_error_handler([](const httplib::Request &, httplib::Response &response) {
            if (response.has_header("Content-Type")) return; // answered already
            refuse(response, response.status,
                   response.status == 404   ? "there is nothing of that name"
                   : response.status == 413 ? "the body is larger than 64 kB"
                                            : "the request cannot be answered");
        });
    }
};

Server::Server(Workshop &workshop, int port, std::string token) : inside_(std::make_unique<Inside>(workshop, std::move(token))) {
    httplib::Server &server = inside_->server;
    server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    server.set_socket_options([](socket_t socket) { // no SO_REUSEPORT: a second server on this port would take every other request
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        fcntl(socket, F_SETFD, FD_CLOEXEC);
    });
    server.set_payload_max_length(most_body);
    server.set_keep_alive_max_count(1); // what a refused request leaves unread is never taken for the next one
    server.set_read_timeout(5, 0);
    server.set_write_timeout(10, 0);
    server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                {"X-Frame-Options", "DENY"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cache-Control", "no-store"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cross-Origin-Opener-Policy", "same-origin"}});
    inside_->routes();
    if (port == 0)
        inside_->port = server.bind_to_any_port(loopback);
    else if (server.bind_to_port(loopback, port))
        inside_->port = port;
    if (inside_->port <= 0)
        throw PortError("--port " + std::to_string(port) + ": cannot be had: " + why_not(port) +
                        "; end what uses it, give another --port, or --port 0 for one that is free");
}

Server::~Server() = default;

int Server::port() const { return inside_->port; }

std::string Server::address() const {
    return std::string("http://") + loopback + ":" + std::to_string(inside_->port) + "/?token=" + inside_->token;
}

void Server::listen() { inside_->server.listen_after_bind(); }

void Server::stop() {
    inside_->over = true;
    inside_->workshop.stop();
    inside_->server.stop();
}

} // namespace traction::serve
