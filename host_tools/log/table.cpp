#include "table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

namespace traction::log {

// ---- cells ----

std::string_view trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

bool parse_number(std::string_view text, bool decimal_comma, double &value) {
    char buffer[64];
    if (decimal_comma && text.find(',') != std::string_view::npos && text.size() < sizeof buffer) {
        std::copy(text.begin(), text.end(), buffer);
        std::replace(buffer, buffer + text.size(), ',', '.');
        text = {buffer, text.size()};
    }
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    if (text.empty() || text.front() == '+') return false;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return false;
    if (error == std::errc::result_out_of_range) { // 1e999 is infinite, 1e-999 is zero
        const std::size_t exponent = text.find_first_of("eE");
        value = exponent != std::string_view::npos && text.find('-', exponent) != std::string_view::npos
                    ? 0.0
                    : std::numeric_limits<double>::infinity();
        return true;
    }
    return error == std::errc{};
}

namespace {

// Texts that people and tools write for "no number here".
bool means_nothing(std::string_view text) {
    for (const std::string_view word : {"NA", "N/A", "n/a", "null", "NULL", "None", "none", "#N/A", "-nan(ind)", "-", "?"}) {
        if (text == word) return true;
    }
    return false;
}

std::string shown(std::string_view text) {
    std::string out = "'";
    for (const char c : text.substr(0, 40)) out += (static_cast<unsigned char>(c) < 32 || c == 127) ? '?' : c;
    return out + (text.size() > 40 ? "...'" : "'");
}

struct Field {
    std::string_view text;
    bool quoted = false;
    bool doubled = false; // holds "" for a quote
};

class TableReader {
  public:
    TableReader(std::string_view text, const std::string &file, const Dialect &dialect, const ReadLimits &limits,
                std::vector<Repair> &repairs)
        : rest_(text), file_(file), dialect_(dialect), limits_(limits), repairs_(repairs) {}

    Table read();

  private:
    bool next_line();
    void split();
    void header_line();
    void guess_separator();
    void take_names();
    void take_row();
    void take_cell(Column &column, double t_s);
    bool row_is_kept();
    bool cell_number(std::size_t index, double &value, bool &finite);
    void note(const char *id, const std::string &signal, std::size_t count, std::size_t line, std::string text) {
        repairs_.push_back({id, signal, count, line, std::move(text)});
    }
    [[noreturn]] void fail(std::size_t column, const std::string &what, const std::string &mend) const {
        throw LogError(file_, line_number_, column, what, mend);
    }

    std::string_view rest_, line_;
    const std::string &file_;
    const Dialect &dialect_;
    const ReadLimits &limits_;
    std::vector<Repair> &repairs_;
    std::size_t line_number_ = 0;
    bool complete_ = true; // the line ends with a line end
    bool crlf_ = false, decimal_comma_ = false;
    std::size_t decimal_commas_ = 0, decimal_comma_line_ = 0, blank_lines_ = 0, blank_line_ = 0, pending_blank_ = 0,
                pending_blank_line_ = 0;
    std::size_t trailing_ = 0, bad_times_ = 0, bad_time_line_ = 0, rows_ = 0, data_lines_ = 0, samples_ = 0;
    char separator_ = ',';
    std::vector<Field> fields_;
    std::size_t time_index_ = 0, fine_index_ = 0;
    bool has_time_ = false;
    std::vector<std::size_t> filter_index_;
    Table table_;
};

bool TableReader::next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    complete_ = end != std::string_view::npos;
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(complete_ ? end + 1 : rest_.size());
    ++line_number_;
    if (!line_.empty() && line_.back() == '\r') {
        line_.remove_suffix(1);
        crlf_ = true;
    }
    return true;
}

void TableReader::split() {
    fields_.clear();
    const char *at = line_.data();
    const char *const end = at + line_.size();
    for (;;) {
        const char *start = at;
        while (start != end && *start == ' ' && separator_ != ' ') ++start;
        if (start != end && *start == '"') {
            const char *scan = start + 1;
            bool doubled = false;
            for (;;) {
                scan = static_cast<const char *>(std::memchr(scan, '"', static_cast<std::size_t>(end - scan)));
                if (scan == nullptr) fail(fields_.size() + 1, "a quote is opened and never closed", "close the quote on the same line");
                if (scan + 1 == end || scan[1] != '"') break;
                doubled = true;
                scan += 2;
                if (scan == end) fail(fields_.size() + 1, "a quote is opened and never closed", "close the quote on the same line");
            }
            fields_.push_back({{start + 1, static_cast<std::size_t>(scan - start - 1)}, true, doubled});
            at = scan + 1;
            while (at != end && *at == ' ') ++at;
            if (at != end && *at != separator_) {
                fail(fields_.size(), "text follows a closed quote", "put a separator after the quote, or write \"\" for a quote inside");
            }
        } else {
            const char *scan = at;
            while (scan != end && *scan != separator_) ++scan;
            fields_.push_back({trim({at, static_cast<std::size_t>(scan - at)}), false, false});
            at = scan;
        }
        if (at == end) return;
        ++at; // the separator
    }
}

void TableReader::header_line() {
    std::string_view text = line_.substr(1);
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return;
    const std::string key(trim(text.substr(0, colon))), value(trim(text.substr(colon + 1)));
    if (key.empty()) return;
    if (key == "format" && dialect_.native) {
        if (value != "traction-log 1") {
            fail(0, "format " + shown(value) + " is not known to this version",
                 "write '# format: traction-log 1', or read it with the traction that wrote it");
        }
        table_.has_format = true;
        return;
    }
    table_.header[key] = value;
}

void TableReader::guess_separator() {
    separator_ = dialect_.separator;
    if (separator_ != 0) {
        decimal_comma_ = separator_ != ',';
        return;
    }
    separator_ = ',';
    bool quoted = false;
    std::size_t commas = 0, semicolons = 0, tabs = 0;
    for (const char c : line_) {
        if (c == '"') quoted = !quoted;
        if (quoted) continue;
        commas += c == ',';
        semicolons += c == ';';
        tabs += c == '\t';
    }
    if (commas == 0 && semicolons + tabs > 0) {
        separator_ = semicolons >= tabs ? ';' : '\t';
        decimal_comma_ = true;
        note("separator", "", 1, line_number_,
             std::string("the columns are separated by ") + (separator_ == ';' ? "semicolons" : "tabs") + ", read as such");
    }
}

void TableReader::take_names() {
    guess_separator();
    split();
    if (fields_.size() > 1 && fields_.back().text.empty() && dialect_.row_of_names) { // a separator at the end of every line
        fields_.pop_back();
        note("trailing_separator", "", 1, line_number_, "a separator ends the row of names, the nameless last column is left out");
    }
    std::map<std::string, std::size_t> seen;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        std::string name(fields_[i].text);
        if (fields_[i].doubled) {
            for (std::size_t at = name.find("\"\""); at != std::string::npos; at = name.find("\"\"", at + 1)) name.erase(at, 1);
        }
        if (!dialect_.row_of_names) name = std::to_string(i + 1);
        double number = 0;
        if (dialect_.row_of_names && parse_number(name, decimal_comma_, number)) {
            fail(i + 1, "there is no row of names: this first row begins with the number " + shown(name),
                 dialect_.native ? "put 't_s,<object>.<quantity>_<unit>,...' above the data, or read the file through a map (--map)"
                                 : "set row_of_names = false in the map and name columns by number");
        }
        if (name.empty()) fail(i + 1, "this column has no name", "name it, or delete the column");
        const auto [where, fresh] = seen.emplace(name, i + 1);
        if (!fresh) {
            fail(i + 1, "column " + shown(name) + " stands twice, first as column " + std::to_string(where->second),
                 "rename or delete one of them");
        }
        table_.names.push_back(name);
    }
    table_.names_line = line_number_;
    const auto index_of = [&](const std::string &name) {
        const auto found = seen.find(name);
        return found == seen.end() ? fields_.size() : found->second - 1;
    };
    if (!dialect_.time_column.empty()) {
        time_index_ = index_of(dialect_.time_column);
        has_time_ = time_index_ != fields_.size();
        if (!has_time_) {
            fail(0,
                 "there is no column '" + dialect_.time_column + "' (found: " + table_.names[0] +
                     (table_.names.size() > 1 ? ", " + table_.names[1] : "") + (table_.names.size() > 2 ? ", ..." : "") + ")",
                 dialect_.native ? "call the column of seconds 't_s', or read the file through a map (--map)"
                                 : "correct time.column in the map");
        }
    }
    if (!dialect_.fine_column.empty()) {
        fine_index_ = index_of(dialect_.fine_column);
        if (fine_index_ == fields_.size())
            fail(0, "there is no column '" + dialect_.fine_column + "'", "correct time.nanoseconds in the map");
    }
    for (const RowFilter &filter : dialect_.filters) {
        filter_index_.push_back(index_of(filter.column));
        if (filter_index_.back() == fields_.size())
            fail(0, "there is no column '" + filter.column + "', which the map filters by", "correct where.column in the map");
    }
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
        const bool is_time = has_time_ && i == time_index_;
        if (dialect_.wanted ? !dialect_.wanted(table_.names[i]) : is_time) continue;
        Column column;
        column.signal.name = table_.names[i];
        column.number = i + 1;
        table_.columns.push_back(std::move(column));
    }
}

// False: no number there. `finite` tells NaN and infinity, however spelled, from a number.
bool TableReader::cell_number(std::size_t index, double &value, bool &finite) {
    const std::string_view text = trim(fields_[index].text);
    if (text.empty()) return false;
    if (means_nothing(text)) {
        finite = false;
        return true;
    }
    if (decimal_comma_ && text.find(',') != std::string_view::npos && decimal_commas_++ == 0) decimal_comma_line_ = line_number_;
    if (!parse_number(text, decimal_comma_, value)) {
        fail(index + 1, shown(text) + " in column '" + table_.names[index] + "' is not a number",
             "write a number, or leave the cell empty where there is no sample");
    }
    finite = std::isfinite(value);
    return true;
}

bool TableReader::row_is_kept() {
    for (std::size_t i = 0; i < filter_index_.size(); ++i) {
        double value = 0;
        bool finite = false;
        if (!cell_number(filter_index_[i], value, finite) || !finite) return false;
        if (value < dialect_.filters[i].minimum || value > dialect_.filters[i].maximum) return false;
    }
    return true;
}

void TableReader::take_cell(Column &column, double t_s) {
    double value = 0;
    bool finite = false;
    if (!cell_number(column.number - 1, value, finite)) return;
    if (!finite) {
        if (column.not_finite++ == 0) column.not_finite_line = line_number_;
        return;
    }
    Signal &signal = column.signal;
    if (!signal.t_s.empty() && t_s <= signal.t_s.back()) {
        if (column.back_steps++ == 0) column.back_line = line_number_;
        if (column.backs.size() < 64 && t_s < signal.t_s.back()) column.backs.emplace_back(signal.t_s.size(), line_number_);
    }
    if (++samples_ > limits_.samples) {
        fail(column.number, "the log holds more than " + std::to_string(limits_.samples) + " samples",
             "cut it into parts, or leave out the fastest columns");
    }
    signal.t_s.push_back(t_s);
    signal.value.push_back(value);
}

void TableReader::take_row() {
    ++data_lines_;
    split();
    if (!complete_) {
        note("cut_last_line", "", 1, line_number_,
             "line " + std::to_string(line_number_) + ": the last line does not end with a line end and may be cut, left out");
        return;
    }
    const std::size_t expected = table_.names.size();
    if (fields_.size() == expected + 1 && fields_.back().text.empty()) {
        if (trailing_++ == 0 && (repairs_.empty() || repairs_.back().id != "trailing_separator")) {
            note("trailing_separator", "", 1, line_number_,
                 "line " + std::to_string(line_number_) + ": a separator ends the line, the empty field after it is left out");
        }
    } else if (fields_.size() != expected) {
        fail(0,
             std::to_string(fields_.size()) + " fields, but the row of names (line " + std::to_string(table_.names_line) + ") has " +
                 std::to_string(expected),
             separator_ == ',' && fields_.size() > expected ? "give every row one field a column; decimal commas need ';' between columns"
                                                            : "give every row one field a column, empty where there is no sample");
    }
    if (!row_is_kept()) return;
    double t_s = static_cast<double>(rows_);
    if (has_time_) {
        bool finite = false;
        if (!cell_number(time_index_, t_s, finite))
            fail(time_index_ + 1, "the row has no time", "write its time in column '" + dialect_.time_column + "', or delete the row");
        double fine = 0;
        if (!dialect_.fine_column.empty()) {
            bool fine_finite = false;
            if (!cell_number(fine_index_, fine, fine_finite))
                fail(fine_index_ + 1, "the row has no time", "write its time in column '" + dialect_.fine_column + "', or delete the row");
            finite = finite && fine_finite;
        }
        if (!finite) {
            if (bad_times_++ == 0) bad_time_line_ = line_number_;
            return;
        }
        t_s += dialect_.fine_scale * fine;
    }
    ++rows_;
    if (!dialect_.native) table_.row_time.push_back(t_s);
    for (Column &column : table_.columns) take_cell(column, t_s);
}

// Other formats that logs come in, by their first bytes.
void refuse_what_is_no_text(std::string_view text, const std::string &file) {
    using namespace std::string_view_literals;
    constexpr std::string_view topics = "export its topics as CSV (PlotJuggler, rostopic echo -p) and name the columns in a map (--map)",
                               table = "write the table as CSV (MATLAB: writetable; pandas: to_csv) and name the columns in a map (--map)";
    constexpr struct {
        std::string_view begins, is, mend;
    } known[] = {{"\xFF\xFE"sv, "text in UTF-16", "save it as UTF-8 (Excel: CSV UTF-8)"},
                 {"\xFE\xFF"sv, "text in UTF-16", "save it as UTF-8 (Excel: CSV UTF-8)"},
                 {"PK\x03\x04"sv, "a zip archive or a spreadsheet", "unpack it, or export the sheet as CSV"},
                 {"\x1F\x8B"sv, "packed by gzip", "unpack it first (gunzip)"},
                 {"#ROSBAG"sv, "a ROS bag", topics},
                 {"SQLite format 3\0"sv, "an SQLite database, as bags of ROS 2 are", topics},
                 {"\x89MCAP"sv, "an MCAP file, which is written here and not read", topics},
                 {"\x89HDF"sv, "an HDF5 file, as MATLAB's are since 7.3", table},
                 {"MATLAB 5"sv, "a MATLAB file", table},
                 {"PAR1"sv, "a Parquet file", table}};
    for (const auto &one : known)
        if (text.substr(0, one.begins.size()) == one.begins)
            throw LogError(file, 1, 0, "this is " + std::string(one.is), std::string(one.mend));
    const std::string_view first = text.substr(0, 4096);
    const auto is_no_text = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && std::string_view("\t\n\v\f\r").find(c) == std::string_view::npos;
    };
    if (std::any_of(first.begin(), first.end(), is_no_text)) throw LogError(file, 1, 0, "this is not a text file", "export the log as CSV");
    if (first.find('\r') != std::string_view::npos && text.find('\n') == std::string_view::npos)
        throw LogError(file, 1, 0, "its lines end with CR alone", "give them LF (tr '\\r' '\\n')");
}

Table TableReader::read() {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") {
        rest_.remove_prefix(3);
        note("byte_order_mark", "", 1, 1, "a byte order mark at the beginning is skipped");
    }
    if (trim(rest_).empty()) throw LogError(file_, 0, 0, "the file is empty", "check the recording, or name another file");
    refuse_what_is_no_text(rest_, file_);
    for (std::size_t i = 0; i < dialect_.skip_rows && next_line(); ++i) {
    }
    bool names_taken = false;
    while (next_line()) {
        if (line_.find_first_not_of(" \t") == std::string_view::npos) {
            if (names_taken && pending_blank_++ == 0) pending_blank_line_ = line_number_;
            continue;
        }
        if (pending_blank_ != 0) { // blank lines at the end mean nothing; in between they are said
            if (blank_lines_ == 0) blank_line_ = pending_blank_line_;
            blank_lines_ += pending_blank_;
            pending_blank_ = 0;
        }
        if (line_.front() == '#') {
            header_line();
            continue;
        }
        if (names_taken) {
            take_row();
            continue;
        }
        take_names();
        names_taken = true;
        if (!dialect_.row_of_names) take_row();
    }
    if (!names_taken)
        throw LogError(file_, line_number_, 0, "there is no row of names and no data",
                       "put 't_s,<object>.<quantity>_<unit>,...' above the data");
    if (data_lines_ == 0)
        throw LogError(file_, table_.names_line, 0, "below the row of names there is no row of data",
                       "check the recording, or name another file");
    if (table_.has_format == false && dialect_.native) {
        note("no_format", "", 1, 1, "there is no line '# format: traction-log 1', read as that");
    }
    if (crlf_) note("crlf", "", 1, 1, "the lines end with CR LF, read as such");
    if (decimal_commas_ != 0) {
        note("decimal_comma", "", decimal_commas_, decimal_comma_line_,
             "line " + std::to_string(decimal_comma_line_) + ": " + std::to_string(decimal_commas_) +
                 " numbers have a decimal comma, read as a point");
    }
    if (blank_lines_ != 0)
        note("blank_line", "", blank_lines_, blank_line_,
             "line " + std::to_string(blank_line_) + ": " + std::to_string(blank_lines_) + " blank lines between the rows are skipped");
    if (bad_times_ != 0) {
        note("time_not_finite", dialect_.time_column, bad_times_, bad_time_line_,
             "line " + std::to_string(bad_time_line_) + ", column " + std::to_string(time_index_ + 1) + ": " + std::to_string(bad_times_) +
                 " rows have a time that is not finite, left out");
    }
    for (const Column &column : table_.columns) {
        if (column.not_finite == 0) continue;
        note("not_finite", column.signal.name, column.not_finite, column.not_finite_line,
             "line " + std::to_string(column.not_finite_line) + ", column " + std::to_string(column.number) + ": " +
                 std::to_string(column.not_finite) + " cells of '" + column.signal.name +
                 "' are NaN, infinite or say 'none', read as no sample");
    }
    return std::move(table_);
}

} // namespace

Table read_table(std::string_view text, const std::string &file, const Dialect &dialect, const ReadLimits &limits,
                 std::vector<Repair> &repairs) {
    return TableReader(text, file, dialect, limits, repairs).read();
}

} // namespace traction::log
