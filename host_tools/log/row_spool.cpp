#include "row_spool.h"

#include "csv_text.h"
#include "write_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

namespace traction::log {

std::size_t RowSpool::add(const std::string &name, bool absent_is_zero, Unit unit) {
    if (columns_.size() > std::numeric_limits<std::uint16_t>::max())
        throw LogError(scratch_.path(), 0, 0, "too many signals for a CSV", "write a ULog (.ulg)");
    Column &fresh = columns_.emplace_back();
    fresh.absent_is_zero = absent_is_zero, fresh.unit = unit;
    names_.push_back(name);
    for (Lane &lane : lanes_) make_room(lane);
    if (lanes_.empty()) start_lane();
    columns_.back().lane = &lanes_.front();
    return columns_.size() - 1;
}

std::size_t RowSpool::bind(const std::vector<std::size_t> &columns) {
    assert(columns.size() <= bound_most);
    Bound &fresh = bound_.emplace_back();
    fresh.lane = &lanes_.front();
    for (const std::size_t column : columns) fresh.columns.push_back(static_cast<std::uint16_t>(column));
    fresh.last.resize(columns.size()), fresh.ever.resize(columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) fresh.never[i / 64] |= std::uint64_t{1} << (i % 64);
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns_[columns[i]].absent_is_zero) fresh.zeros.push_back(static_cast<std::uint8_t>(i));
    fresh.unknown = fresh.never;
    for (Lane &lane : lanes_) make_room(lane);
    return bound_.size() - 1;
}

void RowSpool::make_room(Lane &lane) const {
    const std::size_t count = columns_.size() + bound_.size() * (1 + sizeof(Absent) / sizeof(std::uint32_t)) + copied;
    lane.columns.resize(count);
    lane.whole_columns.resize(count);
    lane.whole_values.resize(count);
    lane.changed_columns.resize(count);
    lane.changed_bits.resize(count);
    const std::size_t one_row = sizeof(RowHead) + count * (sizeof(std::uint16_t) + sizeof(std::uint64_t));
    const std::size_t of_clock = sizeof(RowHead) + sizeof(part::Clock) + by_clock_most * sizeof(std::int32_t);
    const std::size_t room = 2 * chunk_bytes + one_row + of_clock;
    auto bytes = std::make_unique_for_overwrite<char[]>(room); // half of it is seldom touched
    std::copy_n(lane.bytes.get(), lane.used, bytes.get());
    lane.bytes = std::move(bytes);
}

void RowSpool::start_lane() { make_room(lanes_.emplace_back()); }

void RowSpool::refuse(const Place &at, std::size_t column, double t_s, double value) {
    if (refused_.empty()) refused_.push_back({column, at.count, at.last_s, t_s, value});
}

// The lane that takes a sample of a time that is not that of its column's row, the row begun; none where the sample is refused.
RowSpool::Lane *RowSpool::new_row(Place &to, std::size_t column, double t_s, double value) {
    if (!(t_s > to.last_s && t_s < never)) {
        refuse(to, column, t_s, value);
        return nullptr;
    }
    if (!(to.lane->now_s <= t_s)) {
        const auto fits = std::find_if(lanes_.begin(), lanes_.end(), [t_s](const Lane &lane) { return lane.now_s <= t_s; });
        if (fits == lanes_.end()) start_lane();
        to.lane = fits == lanes_.end() ? &lanes_.back() : &*fits;
    }
    Lane &lane = *to.lane;
    if (lane.now_s < t_s) {
        close_row(lane);
        if (lane.used >= 2 * chunk_bytes) put_by();
        lane.now_s = t_s;
    }
    return &lane;
}

void RowSpool::put_in_new_row(std::size_t column, double t_s, double value) {
    Column &to = columns_[column];
    if (Lane *lane = new_row(to, column, t_s, value); lane != nullptr) add_number(to, *lane, column, t_s, value);
}

void RowSpool::put_whole_in_new_row(std::size_t column, double t_s, std::int32_t whole) {
    Column &to = columns_[column];
    if (Lane *lane = new_row(to, column, t_s, value_of(to.unit, whole)); lane != nullptr) add_whole(to, *lane, column, t_s, whole);
}

void RowSpool::put_by_clock(std::size_t column, std::uint32_t first, double rate_Hz, std::span<const std::int32_t> whole) {
    while (!whole.empty()) {
        const std::span<const std::int32_t> some = whole.first(std::min(whole.size(), by_clock_most));
        const part::Clock clock{rate_Hz, first, 0};
        if (const double last_s = clock.t_s(some.size() - 1); some.size() > 1 && clock.t_s(0) < last_s && last_s < never) {
            put_rows_of(clock, column, some);
            whole = whole.subspan(some.size()), first += static_cast<std::uint32_t>(some.size());
        } else { // the clock's numbers begin anew
            put_whole(column, clock.t_s(0), whole[0]);
            whole = whole.subspan(1), ++first;
        }
    }
}

void RowSpool::put_rows_of(const part::Clock &clock, std::size_t column, std::span<const std::int32_t> whole) {
    Column &to = columns_[column];
    const double t_s = clock.t_s(0);
    Lane *lane = new_row(to, column, t_s, value_of(to.unit, whole[0]));
    if (lane == nullptr) return; // nothing is written any more
    close_row(*lane);            // what came with this time already
    if (lane->used >= 2 * chunk_bytes) put_by();
    add(to, *lane, column, t_s);
    lane->pattern = pattern_of(*lane);
    lane->size = 0;
    const RowHead head{t_s, lane->pattern | RowHead::by_clock, static_cast<std::uint16_t>(whole.size()), 0};
    char *at = lane->bytes.get() + lane->used;
    std::memcpy(at, &head, sizeof head);
    std::memcpy(at + sizeof head, &clock, sizeof clock);
    std::memcpy(at + sizeof head + sizeof clock, whole.data(), whole.size_bytes());
    has_grown(*lane, head.size());
    lane->now_s = to.last_s = clock.t_s(whole.size() - 1);
    to.count += whole.size() - 1;
    to.whole = whole.back();
    for (const std::int32_t one : whole) to.all_zero = to.all_zero && one == 0;
}

void RowSpool::put_together(std::size_t bound, double t_s, const std::int32_t *whole, const Absent &absent, std::span<const Other> others) {
    Bound &to = bound_[bound];
    Lane *lane = to.lane;
    if (!(t_s == lane->now_s && t_s > to.last_s)) lane = new_row(to, to.columns[0], t_s, value_of(columns_[to.columns[0]].unit, whole[0]));
    if (lane == nullptr) return;
    add(to, *lane, bound_bit | bound, t_s);
    std::memcpy(&lane->columns[lane->size], &absent, sizeof absent);
    lane->size += sizeof absent / sizeof lane->columns[0];
    const std::size_t count = to.columns.size();
    const std::uint16_t *__restrict column = to.columns.data();
    std::int32_t *__restrict last = to.last.data(), *__restrict ever = to.ever.data();
    std::uint16_t *__restrict columns = lane->whole_columns.data();
    std::int32_t *__restrict values = lane->whole_values.data();
    std::size_t at = lane->whole;
    if (absent == Absent{} && to.unknown == Absent{}) { // nearly always
        for (std::size_t i = 0; i < count; ++i) {       // written each, kept where it is another: no branch that is guessed wrong
            columns[at] = column[i], values[at] = whole[i];
            at += whole[i] != last[i] ? 1 : 0;
        }
        std::copy_n(whole, count, last);
        for (const std::uint8_t i : to.zeros) ever[i] |= whole[i];
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            if (is_absent(absent, i)) continue;
            columns[at] = column[i], values[at] = whole[i];
            at += whole[i] != last[i] || is_absent(to.unknown, i) ? 1 : 0;
            ever[i] |= whole[i], last[i] = whole[i];
        }
    }
    lane->whole = at;
    for (std::size_t n = 0; n < absent.size(); ++n) to.never[n] &= absent[n], to.unknown[n] &= absent[n];
    for (const Other &other : others) to.unknown[other.index / 64] |= std::uint64_t{1} << (other.index % 64);
    for (const Other &other : others) change(to, *lane, column[other.index], std::bit_cast<std::uint64_t>(other.value));
}

// by: what was just added to.
void RowSpool::change(const Place &by, Lane &lane, std::size_t column, std::uint64_t bits) {
    Column &to = columns_[column];
    const auto value = std::bit_cast<double>(bits);
    if (!std::isfinite(value)) refuse({by.last_s, by.count - 1, by.lane}, column, by.last_s, value);
    to.bits = bits;
    to.whole = none;
    to.all_zero = to.all_zero && value == 0;
    lane.changed_columns[lane.changed] = static_cast<std::uint16_t>(column);
    lane.changed_bits[lane.changed++] = bits;
}

// The number of the pattern that the lane's row has, a new one where it is new.
std::uint32_t RowSpool::pattern_of(const Lane &lane) {
    const auto is_this = [&lane](const std::vector<std::uint32_t> &pattern) {
        if (pattern.size() != lane.size || pattern[0] != lane.columns[0]) return false;
        return lane.size == 1 || std::memcmp(pattern.data(), lane.columns.data(), lane.size * sizeof lane.columns[0]) == 0;
    };
    if (lane.pattern < patterns_.size() && is_this(patterns_[lane.pattern])) return lane.pattern;
    const auto found = static_cast<std::uint32_t>(std::find_if(patterns_.begin(), patterns_.end(), is_this) - patterns_.begin());
    if (found == patterns_.size()) {
        patterns_.emplace_back(lane.columns.begin(), lane.columns.begin() + static_cast<std::ptrdiff_t>(lane.size));
        shown_patterns_.push_back(columns_of(lane));
    }
    return found;
}

void RowSpool::close_row(Lane &lane) {
    if (lane.size == 0) return;
    lane.pattern = pattern_of(lane);
    const bool in_bytes = columns_.size() <= 256;
    const RowHead head{lane.now_s, lane.pattern | (in_bytes ? RowHead::in_bytes : 0), static_cast<std::uint16_t>(lane.whole),
                       static_cast<std::uint16_t>(lane.changed)};
    char *to = lane.bytes.get() + lane.used;
    const auto put = [&to](const void *from, std::size_t size) {
        if (size <= copied)
            std::memcpy(to, from, copied); // no call; what is too much is written over, and there is room
        else
            std::memcpy(to, from, size);
        to += size;
    };
    const auto put_columns = [&](const std::vector<std::uint16_t> &columns, std::size_t count) {
        if (!in_bytes) {
            put(columns.data(), count * sizeof columns[0]);
            return;
        }
        const std::uint16_t *__restrict from = columns.data();
        char *__restrict byte = to;
        for (std::size_t i = 0; i < count; ++i) byte[i] = static_cast<char>(from[i]);
        to += count;
    };
    static_assert(sizeof head == copied);
    put(&head, sizeof head);
    if (lane.whole != 0) {
        put_columns(lane.whole_columns, lane.whole);
        put(lane.whole_values.data(), lane.whole * sizeof lane.whole_values[0]);
    }
    if (lane.changed != 0) {
        put_columns(lane.changed_columns, lane.changed);
        put(lane.changed_bits.data(), lane.changed * sizeof lane.changed_bits[0]);
    }
    has_grown(lane, head.size());
    lane.size = lane.whole = lane.changed = 0;
}

std::vector<std::uint32_t> RowSpool::columns_of(const Lane &lane) const {
    std::vector<std::uint32_t> columns;
    for (std::size_t i = 0; i < lane.size; ++i) {
        if ((lane.columns[i] & bound_bit) == 0) {
            columns.push_back(lane.columns[i]);
            continue;
        }
        const Bound &bound = bound_[lane.columns[i] & ~bound_bit];
        Absent absent{};
        std::memcpy(&absent, &lane.columns[i + 1], sizeof absent);
        i += sizeof absent / sizeof lane.columns[0];
        for (std::size_t n = 0; n < bound.columns.size(); ++n)
            if (!is_absent(absent, n)) columns.push_back(bound.columns[n]);
    }
    return columns;
}

// What of bound columns is not kept in them.
void RowSpool::tell_counts() {
    for (const Bound &bound : bound_)
        for (std::size_t i = 0; i < bound.columns.size(); ++i) {
            Column &column = columns_[bound.columns[i]];
            column.count = is_absent(bound.never, i) ? 0 : bound.count;
            const std::int32_t not_zero = column.unit == Unit::exact ? std::numeric_limits<std::int32_t>::max() : -1; // -0 is 0
            column.all_zero = column.all_zero && (bound.ever[i] & not_zero) == 0; // an Other has told its own
        }
}

// What the part's reader must know before the rows that come.
void RowSpool::tell_new_names() {
    if (told_columns_ == 0) scratch_.append(part::Kind::header, part::header_text(header_));
    std::string text;
    for (; told_columns_ < columns_.size(); ++told_columns_)
        text += part::column_line(names_[told_columns_], columns_[told_columns_].absent_is_zero, columns_[told_columns_].unit);
    if (!text.empty()) scratch_.append(part::Kind::columns, text);
    for (; told_patterns_ < patterns_.size(); ++told_patterns_)
        scratch_.append(part::Kind::pattern, part::bytes_of(shown_patterns_[told_patterns_]));
}

// All lanes at once: a block is there or not, and a column that has changed its lane needs both. Of a row that is closed here the rest may
// still come: it is another row of the same time, and goes on in it when the log is written.
void RowSpool::put_by() {
    for (Lane &lane : lanes_) close_row(lane);
    full_ = false;
    used_ = 0;
    std::vector<std::uint32_t> sizes{static_cast<std::uint32_t>(lanes_.size())};
    std::vector<std::string_view> pieces{{}};
    std::size_t size = 0;
    for (const Lane &lane : lanes_) {
        sizes.push_back(static_cast<std::uint32_t>(lane.used));
        pieces.emplace_back(lane.bytes.get(), lane.used);
        size += lane.used;
    }
    if (size == 0) return;
    pieces[0] = part::bytes_of(sizes);
    scratch_.open(); // who cannot write there learns it now, not at the end
    tell_new_names();
    std::uint64_t place = scratch_.append(part::Kind::rows, pieces) + pieces[0].size();
    for (Lane &lane : lanes_) {
        if (lane.used == 0) continue;
        lane.chunks.push_back({place, lane.used});
        place += lane.used;
        lane.used = 0;
    }
    constexpr std::size_t row_that_ends_it = 1024; // and the block's head
    enough_ = scratch_.left_of_stretch();
    enough_ += (enough_ < chunk_bytes / 2 ? Scratch::stretch : 0) - row_that_ends_it;
}

// One lane, row after row.
class RowSpool::Reader {
  public:
    Reader(const RowSpool &spool, const Lane &lane) : spool_(spool), lane_(lane) { next(); }
    double t_s() const { return head_.t_s; } // never: behind the last row
    std::uint32_t pattern() const { return head_.pattern(); }
    // whole(column, number) and other(column, value) of what changed.
    template <typename Whole, typename Other> void each_change(const Whole &whole, const Other &other) const {
        if (head_.is_by_clock()) {
            std::int32_t value = 0;
            std::memcpy(&value, row_ + of_clock_ * sizeof value, sizeof value);
            whole(column_, value);
        } else if (head_.column_size() == 1) {
            each_change_in<std::uint8_t>(whole, other);
        } else {
            each_change_in<std::uint16_t>(whole, other);
        }
    }
    void next() {
        if (head_.is_by_clock() && ++of_clock_ < head_.whole) {
            head_.t_s = clock_.t_s(of_clock_);
            return;
        }
        head_ = {};
        if (at_ == size_ && !open_chunk()) {
            head_.t_s = never;
            return;
        }
        std::memcpy(&head_, data_ + at_, sizeof head_);
        row_ = data_ + at_ + sizeof head_;
        at_ += head_.size();
        if (head_.is_by_clock()) begin_clock();
    }

  private:
    template <typename Column, typename Whole, typename Other> void each_change_in(const Whole &whole, const Other &other) const {
        const char *from = each<Column, std::int32_t>(row_, head_.whole, whole);
        each<Column, double>(from, head_.changed, other);
    }
    template <typename Column, typename Value, typename Do>
    static const char *each(const char *columns, std::size_t count, const Do &what) {
        const char *values = columns + count * sizeof(Column);
        for (std::size_t i = 0; i < count; ++i) {
            Column column = 0;
            Value value{};
            std::memcpy(&column, columns + i * sizeof column, sizeof column);
            std::memcpy(&value, values + i * sizeof value, sizeof value);
            what(column, value);
        }
        return values + count * sizeof(Value);
    }
    void begin_clock() {
        std::memcpy(&clock_, row_, sizeof clock_);
        row_ += sizeof clock_;
        column_ = spool_.shown_patterns_[head_.pattern()][0];
        of_clock_ = 0;
    }
    bool open_chunk() {
        at_ = size_ = 0;
        if (number_ > lane_.chunks.size()) return false;
        if (number_ == lane_.chunks.size()) {
            data_ = lane_.bytes.get();
            size_ = lane_.used;
        } else {
            const Chunk &chunk = lane_.chunks[number_];
            loaded_.resize(chunk.size);
            spool_.scratch_.read(chunk.place, loaded_.data(), chunk.size);
            data_ = loaded_.data();
            size_ = chunk.size;
        }
        ++number_;
        return size_ > 0;
    }
    const RowSpool &spool_;
    const Lane &lane_;
    RowHead head_{};
    part::Clock clock_{};      // where the head is by one
    std::uint32_t column_ = 0; // its column
    std::size_t of_clock_ = 0; // which of its rows
    const char *row_ = nullptr, *data_ = nullptr;
    std::vector<char> loaded_;
    std::size_t number_ = 0, at_ = 0, size_ = 0;
};

// The rows of all lanes, straight into the file.
class RowSpool::Rows {
  public:
    Rows(const RowSpool &spool, const std::string &head, WholeFile &file) : file_(file) {
        std::vector<std::uint32_t> place(spool.columns_.size(), left_out);
        for (std::size_t i = 0; i < place.size(); ++i)
            if (!spool.columns_[i].left_out()) place[i] = static_cast<std::uint32_t>(columns_++);
        shown_of_ = place;
        shown_.resize(columns_);
        for (const Column &column : spool.columns_) unit_.push_back(column.unit);
        for (const std::vector<std::uint32_t> &pattern : spool.shown_patterns_) {
            std::vector<std::uint32_t> cells;
            for (const std::uint32_t column : pattern)
                if (place[column] != left_out) cells.push_back(place[column]);
            std::sort(cells.begin(), cells.end());
            cells_.push_back(std::move(cells));
        }
        for (const Lane &lane : spool.lanes_) readers_.emplace_back(spool, lane);
        room_ = (columns_ + 2) * (number_room + 1) + commas.size();
        size_ = std::max(head.size(), at_once) + room_;
        text_ = std::make_unique_for_overwrite<char[]>(size_);
        to_ = std::copy(head.begin(), head.end(), text_.get());
    }
    void write() {
        for (;;) {
            double now_s = never;
            for (const Reader &reader : readers_) now_s = std::min(now_s, reader.t_s());
            if (now_s == never) break;
            const std::vector<std::uint32_t> *cells = nullptr;
            for (Reader &reader : readers_) {
                for (; reader.t_s() == now_s; reader.next()) {
                    reader.each_change(
                        [this](std::uint32_t column, std::int32_t whole) {
                            show(column, [&](char *to) { return log::put_whole(to, unit_[column], whole); });
                        },
                        [this](std::uint32_t column, double value) { show(column, [&](char *to) { return put_number(to, value); }); });
                    cells = cells == nullptr ? &cells_[reader.pattern()] : together(*cells, cells_[reader.pattern()]);
                }
            }
            if (!cells->empty()) put_row(now_s, *cells);
        }
        file_.write({text_.get(), static_cast<std::size_t>(to_ - text_.get())});
    }

  private:
    static constexpr std::uint32_t left_out = static_cast<std::uint32_t>(-1);
    static constexpr std::size_t at_once = 4 * Scratch::stretch; // of the file
    static constexpr std::size_t many_commas = 96, few_commas = 16;
    static constexpr auto commas = [] {
        std::array<char, many_commas> all{};
        all.fill(',');
        return all;
    }();
    struct Shown { // the text of what a column holds, a comma before it
        std::array<char, number_room + 8> text{','};
        std::size_t size = 0;
    };
    template <typename Put> void show(std::uint32_t column, const Put &put) {
        if (shown_of_[column] == left_out) return;
        Shown &shown = shown_[shown_of_[column]];
        shown.size = static_cast<std::size_t>(put(shown.text.data() + 1) - shown.text.data());
    }
    // No column is in two rows of one time: its times go up.
    const std::vector<std::uint32_t> *together(const std::vector<std::uint32_t> &a, const std::vector<std::uint32_t> &b) {
        std::vector<std::uint32_t> both(a.size() + b.size());
        std::merge(a.begin(), a.end(), b.begin(), b.end(), both.begin());
        both_ = std::move(both);
        return &both_;
    }
    void put_row(double now_s, const std::vector<std::uint32_t> &cells) {
        if (static_cast<std::size_t>(text_.get() + size_ - to_) < room_) flush();
        char *to = put_number(to_, now_s);
        std::size_t at = 0;
        for (const std::uint32_t cell : cells) {
            if (cell != at) to = put_commas(to, cell - at);
            at = cell + 1;
            const Shown &shown = shown_[cell];
            std::memcpy(to, shown.text.data(), number_room); // as many bytes always: quicker, and there is room
            to += shown.size;
        }
        to = put_commas(to, columns_ - at);
        *to++ = '\n';
        to_ = to;
    }
    static char *put_commas(char *to, std::size_t count) {
        if (count <= few_commas)
            std::memcpy(to, commas.data(), few_commas); // no call, as above
        else if (count <= many_commas)
            std::memcpy(to, commas.data(), many_commas);
        else
            std::memset(to, ',', count);
        return to + count;
    }
    void flush() { // to the end of a stretch
        const auto used = static_cast<std::size_t>(to_ - text_.get()), whole = used - used % Scratch::stretch;
        file_.write({text_.get(), whole});
        to_ = std::copy(text_.get() + whole, to_, text_.get());
    }

    WholeFile &file_;
    std::vector<Reader> readers_;
    std::size_t columns_ = 0; // that are written
    std::vector<std::uint32_t> shown_of_;
    std::vector<Shown> shown_;
    std::vector<Unit> unit_;                        // of every column
    std::vector<std::vector<std::uint32_t>> cells_; // of each pattern, in the order of the columns
    std::vector<std::uint32_t> both_;
    std::unique_ptr<char[]> text_;
    std::size_t size_ = 0, room_ = 0; // of it; of a row
    char *to_ = nullptr;
};

void RowSpool::write(const std::map<std::string, std::string> &header) {
    for (const Refused &one : refused_) check_sample(names_[one.column], one.index, one.before_s, one.t_s, one.value, scratch_.path());
    for (Lane &lane : lanes_) close_row(lane);
    tell_counts();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (!columns_[i].left_out()) names.push_back(names_[i]);
    WholeFile file(scratch_.path());
    Rows(*this, csv_head(header, names, scratch_.path()), file).write();
    file.keep();
    scratch_.remove();
}

} // namespace traction::log
