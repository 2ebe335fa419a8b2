#include "report.h"

#include "effect_drawing.h"
#include "page.h"

#include "host_tools/log/write_file.h"

#include <initializer_list>
#include <stdexcept>
#include <string_view>
#include <utility>

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

// The page with each mark, in their order, replaced once.
std::string put_in(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string>> marks) {
    std::string out;
    for (const auto &[mark, text] : marks) {
        const std::size_t place = page.find(mark);
        if (place == std::string_view::npos) throw std::logic_error("the report page has no place for its data");
        out += page.substr(0, place);
        out += text;
        page.remove_prefix(place + mark.size());
    }
    return out += page;
}

} // namespace

std::string to_html(const nlohmann::json &result) {
    const std::string schema = result.is_object() ? result.value("schema", nlohmann::json()).dump() : "no object";
    if (schema != "\"traction.lab/1\"" && schema != "\"traction.figures/1\"" && schema != "\"traction.check/1\"" &&
        schema != "\"traction.compared/1\"" && schema != "\"traction.look/1\"")
        throw ReportError("schema: " + schema +
                          ": no page shows it; give what --json of check, compare, diagnose, add, fit or reproduce wrote "
                          "(traction.check/1, traction.lab/1, traction.figures/1)");
    if (schema == "\"traction.compared/1\"")
        for (const nlohmann::json &one : result.value("results", nlohmann::json::array()))
            if (!one.is_object() || one.value("schema", nlohmann::json()) != "traction.lab/1")
                throw ReportError(
                    "results: only results of the lab stand beside one another (traction.lab/1: compare, diagnose, add, fit)");
    const bool has_drive = result.contains("replay") && result["replay"].is_object();
    nlohmann::json shown = result;
    if (nlohmann::json drawings = drawings_of(result); !drawings.empty()) shown["drawings"] = std::move(drawings);
    return put_in(page_template(),
                  {{"__TRACTION_RESULT__", embeddable(shown)}, {"__TRACTION_SCENE__", has_drive ? std::string(scene_code()) : ""}});
}

void write_html(const nlohmann::json &result, const std::string &path) { write_text(to_html(result), path); }

void write_text(const std::string &text, const std::string &path) { log::write_file(text, path); }

} // namespace traction::report
