#include "log.h"

#include <algorithm>

namespace traction::log {

namespace {

std::string place(const std::string &file, std::size_t line, std::size_t column) {
    std::string text = file;
    if (line != 0) text += ", line " + std::to_string(line);
    if (column != 0) text += ", column " + std::to_string(column);
    return text;
}

// A message is one line of printable text, whatever a damaged file put into a name.
std::string printable(std::string text) {
    for (char &c : text) {
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
    }
    return text;
}

} // namespace

LogError::LogError(std::string file_name, std::size_t line_number, std::size_t column_number, const std::string &what_is_wrong,
                   const std::string &mend_)
    : std::runtime_error(printable(place(file_name, line_number, column_number) + ": " + what_is_wrong + "; to mend: " + mend_)),
      file(std::move(file_name)), line(line_number), column(column_number), mend(mend_) {}

const Signal *Log::find(std::string_view name) const {
    for (const Signal &signal : signals) {
        if (signal.name == name) return &signal;
    }
    return nullptr;
}

double Log::duration_s() const {
    bool any = false;
    double first = 0, last = 0;
    for (const Signal &signal : signals) {
        if (signal.t_s.empty()) continue;
        first = any ? std::min(first, signal.t_s.front()) : signal.t_s.front();
        last = any ? std::max(last, signal.t_s.back()) : signal.t_s.back();
        any = true;
    }
    return last - first;
}

} // namespace traction::log
