#include "report.h"

#include "page.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace traction::report {

namespace {

// JSON that may stand inside a <script> element: no "<" is left that could end it (HTML standard, section 4.12.1.3).
std::string embeddable(const nlohmann::json &result) {
    const std::string text = result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::string out;
    out.reserve(text.size());
    for (const char c : text) {
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    }
    return out;
}

} // namespace

std::string to_html(const nlohmann::json &result) {
    const std::string schema = result.is_object() ? result.value("schema", nlohmann::json()).dump() : "no object";
    if (schema != "\"traction.lab/1\"" && schema != "\"traction.figures/1\"" && schema != "\"traction.check/1\"")
        throw ReportError("schema: " + schema +
                          ": no page shows it; give what --json of check, compare, diagnose, add, fit or reproduce wrote "
                          "(traction.check/1, traction.lab/1, traction.figures/1)");
    const std::string_view page = page_template(), mark = "__TRACTION_RESULT__";
    const std::size_t place = page.find(mark);
    if (place == std::string_view::npos) throw std::logic_error("the report page has no place for its data");
    std::string out(page.substr(0, place));
    out += embeddable(result);
    out += page.substr(place + mark.size());
    return out;
}

void write_html(const nlohmann::json &result, const std::string &path) { write_text(to_html(result), path); }

void write_text(const std::string &text, const std::string &path) {
    const std::string part = path + ".part";
    errno = 0;
    std::ofstream file(part, std::ios::binary);
    file << text;
    file.close();
    if (!file) {
        const int cause = errno != 0 ? errno : EIO;
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw std::filesystem::filesystem_error("cannot write", path, std::error_code(cause, std::generic_category()));
    }
    std::filesystem::rename(part, path);
}

} // namespace traction::report
