#include "flash.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace traction::flash {

namespace {

enum BoardCode { code_done = 0, code_no = 1, code_refused = 3, code_file = 4, code_busy = 5, code_none = 127 };

// Of what the board's program says on its standard error: the last line, without its name.
std::string reason_of(const Answer &answer) {
    std::string text = answer.error;
    while (!text.empty() && text.back() == '\n') text.pop_back();
    const std::size_t line = text.rfind('\n');
    if (line != std::string::npos) text.erase(0, line + 1);
    const std::string own = "traction-slot: ";
    if (text.rfind(own, 0) == 0) text.erase(0, own.size());
    return text;
}

// One of the slots that `status` lists is the good one.
bool has_good(const Answer &status) {
    return std::any_of(status.lines.begin(), status.lines.end(),
                       [](const std::string &line) { return line.rfind("slot ", 0) == 0 && line.find(", good") != std::string::npos; });
}

void need_installer(const FlashOptions &options, const Answer &answer) {
    if (answer.status == code_none)
        throw std::runtime_error(options.board.host + ": " + options.program +
                                 " is not on the board, or not on its PATH; its first flash is told in docs/flash.md");
}

Result after_install(const FlashOptions &options, const std::vector<std::string> &words) {
    using clock = std::chrono::steady_clock;
    const auto end = clock::now() + std::chrono::seconds(options.wait_s);
    std::string why = "the board gave no answer";
    options.step("waits until the new version is healthy, at most " + std::to_string(options.wait_s) + " s");
    while (clock::now() < end && !options.stopped()) {
        const auto left = std::chrono::duration_cast<std::chrono::seconds>(end - clock::now()).count();
        std::vector<std::string> ask = words;
        ask.insert(ask.end(), {"status", "--wait", std::to_string(std::min<long>(5, std::max<long>(1, left)))});
        try {
            const Answer answer = run_on(options.board, ask, "");
            const std::string note = answer.lines.empty() ? "" : answer.lines.back();
            if (answer.status == code_done) return {Outcome::confirmed, note};
            if (answer.status == code_no) return {Outcome::returned, note, has_good(answer)};
            why = answer.status == code_busy ? "it is still on trial" : reason_of(answer);
        } catch (const NoConnection &no) { // the board may be busy with its start
            why = no.what();
            std::this_thread::sleep_for(std::chrono::seconds(1));
        }
    }
    return {Outcome::unknown, why + "; ask again with traction flash --host " + options.board.host + " --status"};
}

} // namespace

const char *name_of(Outcome outcome) {
    switch (outcome) {
    case Outcome::confirmed:
        return "confirmed";
    case Outcome::same:
        return "same";
    case Outcome::checked:
        return "checked";
    case Outcome::installed:
        return "installed";
    case Outcome::returned:
        return "returned";
    case Outcome::unknown:
        return "unknown";
    case Outcome::refused:
        return "refused";
    case Outcome::busy:
        return "busy";
    case Outcome::failed:
        break;
    }
    return "failed";
}

Result flash(const FlashOptions &options, const std::string &package) {
    const std::vector<std::string> words = {options.program, "--folder", options.folder};
    std::vector<std::string> status = words, install = words;
    status.push_back("status");
    const Answer before = run_on(options.board, status, "", options.step);
    need_installer(options, before);
    install.push_back("install");
    if (options.dry_run) install.push_back("--dry-run");
    bool runs = true, same = true;
    options.step("sends " + std::to_string((package.size() + 1023) / 1024) + " kB");
    bool switched = false;
    Answer answer;
    try {
        answer = run_on(options.board, install, package, [&](const std::string &line) {
            options.step(line);
            runs = runs && line.rfind("no version runs", 0) != 0;
            same = same && line.rfind("signature and checksums hold", 0) != 0;
            switched = switched || line.rfind("on trial from the next start", 0) == 0;
        });
    } catch (const NoConnection &) {
        if (!switched) throw; // a package that arrived in part is refused there
    }
    switch (answer.status) {
    case code_done:
        break;
    case code_no:
        return {Outcome::returned, reason_of(answer), has_good(before)};
    case code_refused:
        return {Outcome::refused, reason_of(answer)};
    case code_busy:
        return {Outcome::busy, reason_of(answer)};
    default:
        return {Outcome::failed, reason_of(answer)};
    }
    if (same) return {Outcome::same, ""};
    if (options.dry_run) return {Outcome::checked, ""};
    if (!runs) return {Outcome::installed, "start it there: traction-slot run, or the board's init script"};
    return after_install(options, words);
}

} // namespace traction::flash
