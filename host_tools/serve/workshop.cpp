#include "workshop.h"

#include "child.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

namespace traction::serve {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t most_entries = 500,
                      most_rows = 36000; // an hour of a drive at ten rows a second, of which the half is kept when it is over
constexpr std::chrono::milliseconds look_every{700};

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// A file that is one, not a link; nothing where it cannot be read.
std::optional<std::string> text_of(const fs::path &path) {
    std::error_code error;
    if (fs::symlink_status(path, error).type() != fs::file_type::regular) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(file), {});
}

json parsed(const std::optional<std::string> &text) { return text ? json::parse(*text, nullptr, false) : json(json::value_t::discarded); }

json member(const json &object, const char *key) { return object.is_object() && object.contains(key) ? object.at(key) : json(); }

// What the list of runs says of a result: its sentence, and the errors before and after.
void sum_up(const json &result, json &entry) {
    const json story = member(result, "story"), verdict = member(result, "verdict"), score = member(result, "score");
    for (const json &text : {member(story, "headline"), member(verdict, "text"), member(score, "verdict")})
        if (text.is_string() && !entry.contains("headline")) entry["headline"] = text;
    if (member(result, "schema") == "traction.check/1")
        entry["headline"] = member(result, "passed") == true ? "fit to learn from" : "not fit to learn from until its errors are mended";
    if (member(result, "schema") == "traction.look/1")
        entry["headline"] =
            "the drive, played again; the pose is the " + member(member(result, "replay"), "pose_from").get<std::string>() + "'s";
    if (member(result, "logs").is_array()) entry["logs"] = result["logs"];
    const json recorded = member(result, "recorded");
    if (member(recorded, "statuses").is_number() && member(recorded, "seconds").is_number())
        entry["headline"] =
            recorded["statuses"].dump() + " statuses in " + std::to_string(std::lround(recorded["seconds"].get<double>())) + " s";
    json before = member(score, "error"), after = member(score, "adjusted");
    const bool game = member(result, "schema") == "traction.game/1";
    const json ladder = game ? json() : member(result, "ladder"), guesses = member(result, "guesses");
    if (game && guesses.is_array())
        for (const json &guess : guesses)
            if (member(guess, "effect") == member(entry, "effect") && member(guess, "wheel") == entry.value("wheel", -1))
                before = member(guess, "before"), after = member(guess, "after");
    if (ladder.is_array())
        for (const json &step : ladder)
            if (member(step, "heldout").is_number() && member(step, "label") != "noise floor") {
                if (entry["verb"] == "add" && &step == &ladder.front()) before = step["heldout"];
                after = step["heldout"];
            }
    if (before.is_number()) entry["before"] = before;
    if (after.is_number()) entry["after"] = after;
    if (member(result, "accepted").is_array() && !result["accepted"].empty()) {
        entry["named"] = json::array();
        for (const json &one : result["accepted"])
            entry["named"].push_back({{"effect", member(one, "effect")}, {"wheel", member(one, "wheel")}});
    }
    if (game && member(result, "points").is_number()) entry["headline"] = std::to_string(result["points"].get<int>()) + " of 100 points";
    const json hidden = member(result, "hidden");
    if (hidden.is_string()) entry["hidden"] = hidden;
}

std::string last_lines(const std::string &text) { // of what a verb said on stderr: its message
    const std::size_t at = text.rfind("traction: ");
    std::string message = at == std::string::npos ? text : text.substr(at + 10);
    while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
    return message;
}

// "0.1,0.2,,3" as a JSON array; an empty cell is null. Empty where it is no row of numbers.
std::string row_of(const std::string &line) {
    std::string out = "[";
    std::stringstream cells(line + ",");
    for (std::string cell; std::getline(cells, cell, ',');) {
        char *end = nullptr;
        std::strtod(cell.c_str(), &end);
        if (*end != '\0') return "";
        out += (out.size() > 1 ? "," : "") + (cell.empty() ? "null" : cell);
    }
    return out + "]";
}

std::string event(const char *name, const std::string &data) { return std::string("event: ") + name + "\ndata: " + data + "\n\n"; }

std::string compact(const json &value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

} // namespace

Workshop::Workshop(const fs::path &folder, const fs::path &data, std::string program, std::optional<Rover> rover)
    : folder_(folder, data), alone_((folder_.own() / "history.json").string()), program_(std::move(program)), rover_(std::move(rover)) {
    load_history();
    threads_.emplace_back([this] { watch(); });
    for (const Place place : {lab, drive, watched}) threads_.emplace_back([this, place] { work(place); });
    if (rover_) run({{"verb", "watch"}});
}

Workshop::~Workshop() {
    stop();
    for (std::thread &thread : threads_) thread.join();
}

void Workshop::stop() {
    stopping_ = true;
    const std::lock_guard lock(mutex_);
    slots_[lab].signal = SIGTERM;
    for (const Place place : {drive, watched}) slots_[place].signal = SIGINT; // what was simulated, or received, is kept
    news_.notify_all();
}

std::string Workshop::file_of(int id, const char *ending) const { return (folder_.own() / (std::to_string(id) + ending)).string(); }

void Workshop::load_history() {
    const fs::path path = folder_.own() / "history.json";
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return;
    const json read = parsed(text_of(path));
    if (member(read, "schema") != "traction.serve/1" || !member(read, "runs").is_array()) {
        const fs::path aside = folder_.own() / ("history_" + std::to_string(now_ms()) + ".json");
        fs::rename(path, aside, error);
        trouble_ =
            "traction_serve/history.json is no history any more: it lies in " + aside.filename().string() + " now, the list begins anew";
        return;
    }
    for (const json &entry : read["runs"]) {
        if (!member(entry, "id").is_number_integer() || !member(entry, "verb").is_string() || entry["id"] <= last_id_ ||
            entry["id"] > 1000000000)
            continue;
        history_.push_back(entry);
        last_id_ = entry["id"].get<int>();
        if (member(entry, "state") == "running") history_.back()["state"] = "ended", history_.back()["message"] = "the server ended first";
    }
}

// With the lock held. A history that cannot be kept is told, and the work goes on.
void Workshop::keep_history() {
    while (history_.size() > most_entries) {
        const int id = history_.front()["id"].get<int>();
        for (const char *ending : {".json", ".seal.json"}) {
            std::error_code error;
            fs::remove(file_of(id, ending), error);
        }
        history_.pop_front();
    }
    try {
        log::write_file(json{{"schema", "traction.serve/1"}, {"runs", history_}}.dump(1, ' ', false, json::error_handler_t::replace) + "\n",
                        (folder_.own() / "history.json").string());
        trouble_.clear();
    } catch (const log::FileError &failed) {
        trouble_ = std::string("the history is not kept: ") + failed.what();
    }
}

void Workshop::changed() {
    ++state_;
    ++work_;
    news_.notify_all();
}

void Workshop::watch() {
    std::unique_lock lock(mutex_);
    json before;
    while (!news_.wait_for(lock, look_every, [this] { return stopping_.load(); })) {
        // the look itself reads files: others may go on meanwhile
        Folder folder = folder_;
        lock.unlock();
        const bool other = folder.look();
        lock.lock();
        folder_ = std::move(folder);
        json played = game();
        if (other || played != before) changed();
        before = std::move(played);
    }
}

int Workshop::run(const json &request) {
    const std::lock_guard lock(mutex_);
    const std::string verb = request.is_object() && member(request, "verb").is_string() ? request["verb"].get<std::string>() : "";
    const Place place = place_of(verb);
    Slot &slot = slots_[place];
    if (folder_.look()) changed(); // a file that came this moment is there
    const int id = last_id_ + 1;
    Order order = make_order(request, folder_, file_of(id, ".json"), file_of(id, ".seal.json"), rover_ ? &*rover_ : nullptr);
    if (stopping_) throw Busy("the server ends");
    if (slot.id != 0) throw Busy("something runs already (" + slot.work.value("verb", "") + "): wait for it, or cancel it");
    order.entry["id"] = last_id_ = id;
    order.entry["state"] = "running";
    order.entry["began_ms"] = now_ms();
    history_.push_back(order.entry);
    slot.id = id;
    slot.signal = 0;
    slot.work = {{"id", id}, {"verb", verb}, {"words", "begins"}, {"done", 0}, {"total", 0}};
    slot.order = std::move(order);
    if (place == drive) drive_rows_ = {.id = id, .part = 0, .rows = {}};
    if (place == watched) telemetry_ = {.id = id, .part = 0, .rows = {}};
    changed();
    return id;
}

Workshop::Place Workshop::place_of(const std::string &verb) { return verb == "simulate" ? drive : verb == "watch" ? watched : lab; }

void Workshop::cancel(int id) {
    const std::lock_guard lock(mutex_);
    for (Slot &slot : slots_)
        if (slot.id == id && id > 0) {
            slot.signal = &slot == &slots_[lab] ? SIGTERM : SIGINT;
            slot.work["words"] = "stops";
            ++work_;
            news_.notify_all();
            return;
        }
    throw Busy("number " + std::to_string(id) + " does not run");
}

void Workshop::open_seal(int id) {
    const std::lock_guard lock(mutex_);
    for (json &entry : history_) {
        if (entry["id"] != id || member(entry, "sealed") != true || member(entry, "state") == "running") continue;
        const json seal = parsed(text_of(file_of(id, ".seal.json")));
        if (!member(seal, "effects").is_array()) throw BadRequest("the seal of number " + std::to_string(id) + " cannot be read any more");
        entry["hidden_effects"] = seal["effects"];
        keep_history();
        changed();
        return;
    }
    throw BadRequest("number " + std::to_string(id) + " has no seal to open");
}

std::optional<std::string> Workshop::result(int id) const {
    const std::lock_guard lock(mutex_);
    for (const json &entry : history_)
        if (entry["id"] == id && member(entry, "result") == true) return text_of(file_of(id, ".json"));
    return std::nullopt;
}

// The state of the game in the folder; of one whose seal is closed without its seed.
json Workshop::game() const {
    const fs::path folder = folder_.root() / "game";
    std::error_code error;
    if (fs::symlink_status(folder, error).type() != fs::file_type::directory) return nullptr;
    json state = parsed(text_of(folder / "game.json"));
    if (member(state, "schema") != "traction.game/1" || !member(state, "opened").is_boolean()) return nullptr;
    json shown;
    for (const char *key : {"soil", "level", "guesses", "ladder", "opened"}) shown[key] = member(state, key);
    if (state["opened"] == true)
        for (const char *key : {"seed", "hidden", "points"}) shown[key] = member(state, key);
    return shown;
}

json Workshop::state_now() const {
    return {{"folder", folder_.root().string()},
            {"rover", rover_ ? json{{"host", rover_->host}, {"keyed", !rover_->key.empty()}} : json()},
            {"files", folder_.json()},
            {"history", json(std::vector<json>(history_.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(100, history_.size())),
                                               history_.end()))},
            {"game", game()},
            {"trouble", trouble_.empty() ? folder_.trouble() : trouble_}};
}

json Workshop::history() const {
    const std::lock_guard lock(mutex_);
    return history_;
}

json Workshop::state() const {
    const std::lock_guard lock(mutex_);
    return state_now();
}

bool Workshop::fresh(const Rows &rows, const Seen::Rows &seen) {
    return rows.id > 0 && (seen.id != rows.id || seen.part != rows.part || seen.count < rows.rows.size());
}

// The rows that were not seen yet, all of them where others were.
std::string Workshop::news(const char *name, const Rows &rows, Seen::Rows &seen) {
    if (!fresh(rows, seen)) return "";
    const std::size_t from = seen.id == rows.id && seen.part == rows.part ? seen.count : 0;
    std::string text;
    for (std::size_t i = from; i < rows.rows.size(); ++i) text += (i == from ? "" : ",") + rows.rows[i];
    seen = {.id = rows.id, .part = rows.part, .count = rows.rows.size()};
    return event(name, "{\"id\":" + std::to_string(rows.id) + ",\"from\":" + std::to_string(from) + ",\"rows\":[" + text + "]}");
}

std::string Workshop::events(Seen &seen, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    const auto some = [&] {
        return stopping_ || seen.state != state_ || seen.work != work_ || fresh(drive_rows_, seen.drive) ||
               fresh(telemetry_, seen.telemetry);
    };
    if (!news_.wait_for(lock, longest, some) || stopping_) return "";
    std::string out;
    if (seen.state != state_) out += event("state", compact(state_now()));
    if (seen.work != work_) {
        json running = json::array();
        for (const Slot &slot : slots_)
            if (slot.id != 0) running.push_back(slot.work);
        out += event("work", compact(running));
    }
    out += news("rows", drive_rows_, seen.drive);
    out += news("telemetry", telemetry_, seen.telemetry);
    seen.state = state_;
    seen.work = work_;
    return out;
}

void Workshop::row(Rows &rows, int id, const std::string &line) {
    std::string row = row_of(line);
    if (row.empty()) return;
    const std::lock_guard lock(mutex_);
    if (rows.id != id) return;
    if (rows.rows.size() >= most_rows) {
        rows.rows.erase(rows.rows.begin(), rows.rows.begin() + most_rows / 2);
        ++rows.part;
    }
    rows.rows.push_back(std::move(row));
    news_.notify_all();
}

// Runs the order's commands; the entry as it stands at the end.
json Workshop::done(const Order &order, Slot &slot, int id, Place place) {
    json entry = order.entry;
    Listening listening;
    listening.progress = [&](long steps, long total, const std::string &words) {
        const std::lock_guard lock(mutex_);
        if (slot.signal != 0) return;
        slot.work["done"] = steps, slot.work["total"] = total, slot.work["words"] = words;
        ++work_;
        news_.notify_all();
    };
    if (order.live) listening.line = [&](const std::string &line) { row(place == drive ? drive_rows_ : telemetry_, id, line); };
    Finished finished;
    try {
        for (const std::vector<std::string> &command : order.commands) {
            finished = run_child(program_, command, listening, slot.signal);
            if (finished.exit_code > 1 || slot.signal != 0) break;
        }
    } catch (const std::runtime_error &error) {
        finished.exit_code = 70, finished.trouble = error.what();
    }
    const bool stopped = slot.signal != 0 && finished.exit_code > 1;
    entry["state"] = stopped ? "cancelled" : finished.exit_code <= 1 ? "done" : "failed";
    entry["exit_code"] = finished.exit_code;
    entry["ended_ms"] = now_ms();
    if (order.game) entry["text"] = finished.out.substr(0, 6000);
    if (entry["state"] == "failed") {
        entry["message"] = last_lines(finished.trouble);
        if (entry["message"] == "") entry["message"] = "it ended with code " + std::to_string(finished.exit_code) + " and said nothing";
    }
    const json result = parsed(text_of(file_of(id, ".json")));
    if (!result.is_discarded()) {
        entry["result"] = true;
        sum_up(result, entry);
    }
    std::error_code error;
    for (const char *made : {"log", "made"}) // what was to be written, and was not
        if ((made == std::string("made") || place != lab || order.entry["verb"] == "rover_fetch") && entry.contains(made) &&
            !fs::exists(folder_.root() / entry[made].get<std::string>(), error))
            entry.erase(made);
    return entry;
}

void Workshop::work(Place place) {
    Slot &slot = slots_[place];
    std::unique_lock lock(mutex_);
    for (;;) {
        news_.wait(lock, [&] { return stopping_ || slot.order; });
        if (stopping_) return;
        const Order order = *std::exchange(slot.order, std::nullopt);
        const int id = slot.id;
        lock.unlock();
        json entry = done(order, slot, id, place);
        lock.lock();
        folder_.look();
        const bool spoke = entry.contains("text"); // the game's words: the last ones are enough
        for (json &old : history_) {
            if (spoke) old.erase("text");
            if (old["id"] == id) old = std::move(entry);
        }
        keep_history();
        slot.id = 0;
        slot.work = nullptr;
        changed();
    }
}

} // namespace traction::serve
