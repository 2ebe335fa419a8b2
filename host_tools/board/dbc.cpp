#include "dbc.h"

#include "host_tools/log/log.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <regex>
#include <set>

namespace traction::board {

namespace {

template <typename Number> Number number_of(const std::string &text) {
    Number value{};
    const char *begin = text.c_str() + (text.starts_with('+') ? 1 : 0);
    std::from_chars(begin, text.c_str() + text.size(), value);
    return value;
}

// The place of the signal's bit i, counted from its lowest, as byte * 8 + bit.
int place_of(const DbcSignal &signal, int i) {
    if (signal.intel) return signal.start + i;
    // counted from the highest bit of byte 0 on, a Motorola signal is one run
    const int highest = signal.start / 8 * 8 + 7 - signal.start % 8, at = highest + signal.length - 1 - i;
    return at / 8 * 8 + 7 - at % 8;
}

class DbcReader {
  public:
    explicit DbcReader(const std::string &path) : path_(path) {}

    Dbc read() {
        std::ifstream file(path_);
        if (!file.is_open()) throw log::FileError(path_, 0, 0, "cannot be read", "give a file that is there");
        for (std::string line; std::getline(file, line);) {
            ++line_;
            if (!line.empty() && line.back() == '\r') line.pop_back();
            const std::size_t begin = line.find_first_not_of(" \t");
            if (begin == std::string::npos) {
                now_ = nullptr;
            } else if (line.compare(begin, 4, "BO_ ") == 0) {
                message(line.substr(begin));
            } else if (line.compare(begin, 4, "SG_ ") == 0 && now_ != nullptr) {
                signal(line.substr(begin));
            } else if (line.compare(begin, 13, "SIG_VALTYPE_ ") == 0) {
                value_type(line.substr(begin));
            }
        }
        if (file.bad()) throw log::FileError(path_, 0, 0, "cannot be read", "give a file, no folder");
        if (dbc_.empty()) throw log::LogError(path_, 0, 0, "names no message (BO_)", "give a DBC file");
        return std::move(dbc_);
    }

  private:
    [[noreturn]] void refuse(const std::string &what, const std::string &mend) const { throw log::LogError(path_, line_, 0, what, mend); }

    void message(const std::string &line) {
        static const std::regex form(R"(BO_\s+(\d{1,10})\s+(\w+)\s*:\s*(\d{1,3})\s+\S+.*)");
        std::smatch part;
        if (!std::regex_match(line, part, form)) refuse("'" + line + "' is no message", "BO_ ID NAME: BYTES SENDER");
        const auto id = static_cast<std::uint32_t>(number_of<std::uint64_t>(part[1].str()));
        if (dbc_.contains(id)) refuse("message " + part[1].str() + " stands twice", "give every message its own id");
        now_ = &dbc_[id];
        now_->name = part[2].str();
        now_->bytes = number_of<int>(part[3].str());
        if (!messages_.insert(now_->name).second) refuse("two messages are called " + now_->name, "give every message its own name");
        names_.clear();
        if (now_->bytes > 64) refuse("a message of " + part[3].str() + " bytes", "a frame has 64 at most");
    }

    void signal(const std::string &line) {
        static const std::regex form(R"(SG_\s+(\w+)\s*(M|m\d+M?)?\s*:\s*(\d{1,3})\|(\d{1,2})@([01])([+-])\s*\(([^,]+),([^)]+)\).*)");
        std::smatch part;
        if (!std::regex_match(line, part, form))
            refuse("'" + line + "' is no signal", "SG_ NAME : START|BITS@ORDER+ (FACTOR,OFFSET) [LOW|HIGH] \"UNIT\" RECEIVERS");
        const std::string multiplex = part[2].str();
        DbcSignal made{.name = part[1].str(),
                       .start = number_of<int>(part[3].str()),
                       .length = number_of<int>(part[4].str()),
                       .intel = part[5].str() == "1",
                       .is_signed = part[6].str() == "-",
                       .floating = 0,
                       .factor = number_of<double>(part[7].str()),
                       .offset = number_of<double>(part[8].str()),
                       .multiplex = multiplex.starts_with('m') ? number_of<int>(multiplex.substr(1)) : -1,
                       .multiplexor = multiplex == "M"};
        if (multiplex.starts_with('m') && multiplex.ends_with('M'))
            refuse("signal " + made.name + " is multiplexed and multiplexes", "one level is read; take such signals out of the file");
        if (made.length < 1 || made.length > 64) refuse("signal " + made.name + " of " + part[4].str() + " bits", "give 1 to 64");
        if (!names_.insert(made.name).second) refuse("signal " + made.name + " stands twice", "give every signal its own name");
        if (made.multiplexor &&
            std::any_of(now_->signals.begin(), now_->signals.end(), [](const DbcSignal &other) { return other.multiplexor; }))
            refuse("a second multiplexor, " + made.name, "a message has one");
        if (!dbc_fits(made, std::string(static_cast<std::size_t>(now_->bytes), '\0')))
            refuse("signal " + made.name + " lies beyond the message's " + std::to_string(now_->bytes) + " bytes", "mend start or bits");
        now_->signals.push_back(made);
    }

    void value_type(const std::string &line) {
        static const std::regex form(R"(SIG_VALTYPE_\s+(\d{1,10})\s+(\w+)\s*:?\s*([0-3])\s*;.*)");
        std::smatch part;
        if (!std::regex_match(line, part, form)) refuse("'" + line + "' is no value type", "SIG_VALTYPE_ ID NAME : 1;");
        const auto found = dbc_.find(static_cast<std::uint32_t>(number_of<std::uint64_t>(part[1].str())));
        if (found == dbc_.end()) refuse("no message " + part[1].str() + " before", "the types stand below the messages");
        for (DbcSignal &one : found->second.signals) {
            if (one.name != part[2].str()) continue;
            one.floating = part[3].str() == "1" ? 32 : part[3].str() == "2" ? 64 : 0;
            if (one.floating != 0 && one.floating != one.length)
                refuse("signal " + one.name + " of " + std::to_string(one.length) + " bits is no such float",
                       "a float has 32 bits, a double 64");
        }
    }

    std::string path_;
    std::size_t line_ = 0;
    Dbc dbc_;
    DbcMessage *now_ = nullptr;
    std::set<std::string> names_, messages_; // of this message's signals, of all messages
};

} // namespace

Dbc read_dbc(const std::string &path) { return DbcReader(path).read(); }

bool dbc_fits(const DbcSignal &signal, std::string_view data) {
    const int bits = static_cast<int>(data.size()) * 8, first = place_of(signal, 0), last = place_of(signal, signal.length - 1);
    return std::max(first, last) < bits && std::min(first, last) >= 0;
}

std::uint64_t dbc_raw(const DbcSignal &signal, std::string_view data) {
    std::uint64_t raw = 0;
    for (int i = signal.length; i-- > 0;) {
        const int place = place_of(signal, i);
        const auto byte = static_cast<std::uint8_t>(data[static_cast<std::size_t>(place / 8)]);
        raw = raw << 1u | (static_cast<unsigned>(byte) >> static_cast<unsigned>(place % 8) & 1u);
    }
    return raw;
}

double dbc_value(const DbcSignal &signal, std::string_view data) {
    const std::uint64_t raw = dbc_raw(signal, data);
    if (signal.floating == 32)
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw))) * signal.factor + signal.offset;
    if (signal.floating == 64) return std::bit_cast<double>(raw) * signal.factor + signal.offset;
    const auto unused = static_cast<unsigned>(64 - signal.length);
    const double number =
        signal.is_signed ? static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused) : static_cast<double>(raw);
    return number * signal.factor + signal.offset;
}

} // namespace traction::board
