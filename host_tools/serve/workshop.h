// workshop.h - what all browsers of one `traction serve` share: the folder, the history of what was run, what runs now, the drive that is
// being simulated, the rover that is watched. One verb of the lab (or of the game), one drive and one watch may run side by side.
//
// Thread-safe. The history stands in traction_serve/history.json of the folder (schema traction.serve/1), each result beside it as ID.json.
#pragma once

#include "folder.h"
#include "order.h"

#include "host_tools/log/write_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace traction::serve {

// What is asked for cannot be done now: something runs already, or is over. HTTP status 409.
struct Busy : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Workshop {
  public:
    // program: the traction that runs the verbs. rover: watched from now on. Throws log::FileError.
    Workshop(const std::filesystem::path &folder, const std::filesystem::path &data, std::string program,
             std::optional<Rover> rover = std::nullopt);
    ~Workshop(); // ends what runs
    Workshop(const Workshop &) = delete;
    Workshop &operator=(const Workshop &) = delete;

    int run(const nlohmann::json &request); // order.h; the number it has in the history. Throws BadRequest, Busy.
    void cancel(int id);                    // throws Busy where it does not run
    void open_seal(int id);                 // what a simulated drive hid goes into its entry. Throws BadRequest.
    std::optional<std::string> result(int id) const;
    nlohmann::json state() const;   // of the history the last 100 runs
    nlohmann::json history() const; // all of it

    // What a browser has seen already; a fresh one has seen nothing.
    struct Seen {
        std::uint64_t state = 0, work = 0;
        struct Rows {
            int id = -1;
            unsigned part = 0;
            std::size_t count = 0;
        } drive, telemetry;
    };
    // Server-sent events that bring `seen` up to date; empty when nothing happened for so long, or when all ends.
    std::string events(Seen &seen, std::chrono::milliseconds longest);

    void stop();
    bool stopped() const { return stopping_; }

  private:
    enum Place { lab, drive, watched };
    struct Slot {
        std::optional<Order> order;
        int id = 0; // 0: free
        nlohmann::json work;
        std::atomic<int> signal{0};
    };
    // What a run tells while it goes on: the latest hour and more, in `part` that begins anew when the older half is let go.
    struct Rows {
        int id = -1;
        unsigned part = 0;
        std::vector<std::string> rows;
    };
    static Place place_of(const std::string &verb);
    static bool fresh(const Rows &rows, const Seen::Rows &seen);
    static std::string news(const char *name, const Rows &rows, Seen::Rows &seen);
    void load_history();
    void keep_history();
    void watch();
    void work(Place place);
    nlohmann::json done(const Order &order, Slot &slot, int id, Place place);
    void row(Rows &rows, int id, const std::string &line);
    void changed();
    std::string file_of(int id, const char *ending) const;
    nlohmann::json game() const;
    nlohmann::json state_now() const;

    mutable std::mutex mutex_;
    std::condition_variable news_;
    Folder folder_;
    log::Claim alone_; // of the history: one server a folder
    std::string program_;
    std::deque<nlohmann::json> history_;
    std::string trouble_;
    int last_id_ = 0;
    std::optional<Rover> rover_;
    std::array<Slot, 3> slots_;
    Rows drive_rows_, telemetry_;
    std::uint64_t state_ = 1, work_ = 1;
    std::atomic<bool> stopping_{false};
    std::vector<std::thread> threads_;
};

} // namespace traction::serve
