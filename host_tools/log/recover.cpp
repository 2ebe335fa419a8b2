#include "recover.h"

#include "csv_text.h"
#include "part.h"
#include "spool.h"
#include "table.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace traction::log {

namespace {

struct Damage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void need(bool good, const char *otherwise) {
    if (!good) throw Damage(otherwise);
}

// Bytes from front to back, never beyond their end.
class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : rest_(bytes) {}
    bool empty() const { return rest_.empty(); }
    std::string_view take(std::size_t size) {
        need(size <= rest_.size(), "it ends too early");
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    template <typename Number> Number number() {
        Number number{};
        std::memcpy(&number, take(sizeof number).data(), sizeof number);
        return number;
    }
    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        need(end != std::string_view::npos, "a line has no end");
        return take(end + 1).substr(0, end);
    }

  private:
    std::string_view rest_;
};

// One lane of a block of rows.
class LaneRows {
  public:
    LaneRows(std::string_view bytes, const std::vector<std::vector<std::uint32_t>> &patterns) : rest_(bytes), patterns_(patterns) {
        next();
    }
    double t_s() const { return head_.t_s; } // never: behind the last row
    std::uint32_t pattern() const { return head_.pattern(); }
    // whole(column, number) and other(column, value) of what changed.
    template <typename Whole, typename Other> void each_change(const Whole &whole, const Other &other) {
        if (head_.is_by_clock())
            whole(column_, values_.number<std::int32_t>());
        else if (head_.column_size() == 1)
            each<std::uint8_t, std::int32_t>(head_.whole, whole), each<std::uint8_t, double>(head_.changed, other);
        else
            each<std::uint16_t, std::int32_t>(head_.whole, whole), each<std::uint16_t, double>(head_.changed, other);
    }
    void next() { // behind each_change
        if (head_.is_by_clock() && !values_.empty()) {
            head_.t_s = clock_.t_s(++of_clock_);
        } else {
            head_ = {.t_s = never, .marked_pattern = 0, .whole = 0, .changed = 0};
            if (rest_.empty()) return;
            head_ = rest_.number<part::RowHead>();
            if (head_.is_by_clock()) begin_clock();
        }
        need(std::isfinite(head_.t_s), "a row's time is no number");
    }

  private:
    void begin_clock() {
        clock_ = rest_.number<part::Clock>();
        values_ = Bytes(rest_.take(head_.whole * sizeof(std::int32_t)));
        of_clock_ = 0;
        need(!values_.empty(), "a clock has no sample");
        need(head_.pattern() < patterns_.size() && patterns_[head_.pattern()].size() == 1, "a clock is not of one column");
        column_ = patterns_[head_.pattern()][0];
    }
    template <typename Column, typename Value, typename Do> void each(std::size_t count, const Do &what) {
        Bytes columns(rest_.take(count * sizeof(Column))), values(rest_.take(count * sizeof(Value)));
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t column = columns.number<Column>();
            what(column, values.number<Value>());
        }
    }
    Bytes rest_, values_{{}}; // values_: of the clock
    const std::vector<std::vector<std::uint32_t>> &patterns_;
    part::RowHead head_{};
    part::Clock clock_{};
    std::uint32_t column_ = 0;
    std::size_t of_clock_ = 0;
};

// What the blocks say, into a log.
class Reading {
  public:
    explicit Reading(const std::string &out) : log_(out, Scratch::Name::none) {}

    void take(std::uint32_t kind, std::string_view payload) {
        switch (static_cast<part::Kind>(kind)) {
        case part::Kind::header:
            take_header(Bytes(payload));
            return;
        case part::Kind::columns:
            take_columns(Bytes(payload));
            return;
        case part::Kind::pattern:
            take_pattern(Bytes(payload));
            return;
        case part::Kind::rows:
            take_rows(Bytes(payload));
            return;
        case part::Kind::samples:
            take_samples(Bytes(payload));
            return;
        case part::Kind::filling:
            return;
        }
        throw Damage("it is of a kind that this version does not know");
    }
    void write() {
        header_["ended"] = "interrupted";
        log_.write(header_);
    }
    Recovered told;

  private:
    struct Held { // what a column held last
        enum { nothing, whole_number, number } as = nothing;
        std::int32_t whole = 0;
        double value = 0;
    };
    void take_header(Bytes lines) {
        while (!lines.empty()) {
            const std::string_view line = lines.line();
            const std::size_t colon = line.find(": ");
            need(colon != std::string_view::npos, "a line of its header has no value");
            header_[std::string(line.substr(0, colon))] = line.substr(colon + 2);
        }
    }
    void take_columns(Bytes lines) {
        while (!lines.empty()) {
            const std::string_view line = lines.line();
            const std::size_t unit = line.size() > 2 ? part::unit_letters.find(line[1]) : std::string_view::npos;
            need(unit != std::string_view::npos && (line.front() == '-' || line.front() == '0'), "a column has no name");
            log_.add(std::string(line.substr(2)), line.front() == '0', 0, static_cast<Unit>(unit));
            held_.emplace_back();
        }
    }
    void take_pattern(Bytes numbers) {
        std::vector<std::uint32_t> &pattern = patterns_.emplace_back();
        while (!numbers.empty()) pattern.push_back(known(numbers.number<std::uint32_t>()));
    }
    void take_rows(Bytes block) {
        std::vector<std::uint32_t> sizes;
        Bytes numbers(block.take(block.number<std::uint32_t>() * std::size_t{sizeof(std::uint32_t)}));
        while (!numbers.empty()) sizes.push_back(numbers.number<std::uint32_t>());
        std::vector<LaneRows> lanes;
        for (const std::uint32_t size : sizes) lanes.emplace_back(block.take(size), patterns_);
        for (;;) {
            const auto first =
                std::min_element(lanes.begin(), lanes.end(), [](const LaneRows &a, const LaneRows &b) { return a.t_s() < b.t_s(); });
            if (first == lanes.end() || first->t_s() == never) return;
            take_row(*first);
            first->next();
        }
    }
    void take_row(LaneRows &row) {
        row.each_change(
            [this](std::uint32_t column, std::int32_t whole) {
                held_[known(column)] = {Held::whole_number, whole, 0};
            },
            [this](std::uint32_t column, double value) {
                held_[known(column)] = {Held::number, 0, value};
            });
        need(row.pattern() < patterns_.size(), "it names a pattern that there is not");
        for (const std::uint32_t column : patterns_[row.pattern()]) {
            const Held &held = held_[column];
            need(held.as != Held::nothing, "a column has a sample and no value");
            if (held.as == Held::whole_number)
                log_.put_whole(column, row.t_s(), held.whole);
            else
                log_.put(column, row.t_s(), held.value);
            told.samples++;
        }
        told.last_s = std::max(told.last_s, row.t_s());
    }
    void take_samples(Bytes block) {
        Bytes numbers(block.take(block.number<std::uint32_t>() * 2 * sizeof(std::uint32_t)));
        while (!numbers.empty()) {
            const std::uint32_t column = known(numbers.number<std::uint32_t>()), count = numbers.number<std::uint32_t>();
            Bytes times(block.take(count * sizeof(double))), values(block.take(count * sizeof(double)));
            for (std::uint32_t i = 0; i < count; ++i) {
                const double t_s = times.number<double>();
                log_.put(column, t_s, values.number<double>());
                told.samples++;
                told.last_s = std::max(told.last_s, t_s);
            }
        }
    }
    std::uint32_t known(std::uint32_t column) const {
        need(column < held_.size(), "it names a column that there is not");
        return column;
    }

    Spool log_;
    std::map<std::string, std::string> header_;
    std::vector<Held> held_;
    std::vector<std::vector<std::uint32_t>> patterns_;
};

// The blocks in turn. Returns behind the last whole one.
std::size_t read_blocks(std::string_view bytes, Reading &reading) {
    std::size_t at = part::magic.size();
    try {
        while (bytes.size() - at >= sizeof(part::BlockHead)) {
            part::BlockHead head{};
            std::memcpy(&head, bytes.data() + at, sizeof head);
            need(head.check == part::head_check(head), "it does not begin as one");
            if (head.size > bytes.size() - at - sizeof head) break;
            const std::string_view payload = bytes.substr(at + sizeof head, head.size);
            need(head.payload_check == part::crc_after(0, payload.data(), payload.size()), "its content is not what was written");
            reading.take(head.kind, payload);
            at += sizeof head + head.size;
        }
    } catch (const Damage &damage) {
        reading.told.damage = damage.what();
    }
    return at;
}

// A run that still writes it holds its lock. A file system without locks: nobody knows.
void must_be_left(const std::string &part) {
    const int fd = ::open(part.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return; // FileBytes says why
    const bool taken = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(fd);
    if (taken)
        throw FileError(part, 0, 0, "is being written by a run that goes on", "wait for it, or end it by Ctrl-C, which leaves a whole log");
}

} // namespace

Recovered recover(const std::string &part, const std::string &out) {
    must_be_left(part);
    const FileBytes bytes(part, std::numeric_limits<std::size_t>::max());
    if (!part::begins_as_part(bytes.view()))
        throw LogError(part, 0, 0, "is not what a run that was ended has left", "name the file LOG.part that lies beside the log's place");
    Reading reading(out);
    reading.told.lost_at = read_blocks(bytes.view(), reading);
    reading.told.lost_bytes = bytes.view().size() - reading.told.lost_at;
    if (reading.told.samples == 0)
        throw LogError(part, 0, 0, "has no whole row" + (reading.told.damage.empty() ? "" : ": a block is damaged, " + reading.told.damage),
                       "nothing is lost that could be had; run it again");
    reading.write();
    return reading.told;
}

} // namespace traction::log
