// verb_flash.cpp - traction flash: a signing key, a package, a package as a board's image, and a package onto a board over ssh
// (docs/flash.md).
#include "data_files.h"
#include "help.h"
#include "rows.h"
#include "stop_signal.h"
#include "verbs.h"

#include "host_tools/flash/flash.h"
#include "host_tools/flash/image.h"
#include "host_tools/flash/pack.h"
#include "host_tools/log/write_file.h"
#include "sim/scenario/rover.h"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::cli {

namespace {

struct FlashArguments {
    std::string package, new_key, pack, key, program, rover, parameters, host, user = "root", identity, known_hosts, ssh = "ssh";
    std::string folder = "/opt/traction", installer = "traction-slot";
    std::string image, system, mount = "/", architecture = "armel";
    int port = 22, wait_s = 90, erase_kB = 256, size_kB = 0;
    bool dry_run = false, status = false;
};

nlohmann::json package_json(const flash::Summary &s) {
    nlohmann::json files = nlohmann::json::array();
    for (const auto &[name, size] : s.files) files.push_back({{"name", name}, {"bytes", size}});
    return {{"version", s.version}, {"commit", s.commit}, {"architecture", s.architecture},
            {"rover", s.rover},     {"key", s.key},       {"number", s.number},
            {"bytes", s.bytes},     {"files", files}};
}

void tell_package(const flash::Summary &s) {
    std::printf("number %u of key %.8s, for %s (%s), version %s, commit %s\n", s.number, s.key.c_str(), s.rover.c_str(),
                s.architecture.c_str(), s.version.c_str(), s.commit.c_str());
    for (const auto &[name, size] : s.files) std::printf("  %-14s %8u bytes\n", name.c_str(), size);
}

// A file of the source tree, or where an installation has it.
std::string own_file(const std::string &in_tree, const std::string &installed) {
    const std::filesystem::path root = need_data_root();
    for (const std::string &one : {in_tree, installed})
        if (std::filesystem::exists(root / one)) return (root / one).string();
    return "";
}

void make_key(const FlashArguments &a, Outcome &outcome) {
    const flash::PublicKey key = flash::make_key(a.new_key);
    char id[2 * LMS_ID + 1];
    package_hex(key.data() + 8, LMS_ID, id);
    std::printf(
        "%s: a signing key for 1024 packages; keep it, and never two copies of it\n%s.pub: what the rover gets (traction-slot init)\n",
        a.new_key.c_str(), a.new_key.c_str());
    outcome.json = {{"schema", "traction.flash/1"}, {"action", "new_key"}, {"key", id}, {"key_file", a.new_key}};
}

void pack(const FlashArguments &a, Outcome &outcome) {
    if (a.key.empty()) throw UsageError("--pack needs the signer's key; give --key FILE (--new-key makes one)");
    if (a.rover.empty()) throw UsageError("--pack needs the rover's description; give --rover FILE (rovers/*.toml)");
    flash::Contents contents{.program = a.program.empty() ? own_file("build/korebot/firmware/app/tractiond", "") : a.program,
                             .rover = a.rover,
                             .parameters = a.parameters,
                             .start = own_file("firmware/flash/start", "flash/start"),
                             .check = data_file("cruise", "scenarios"),
                             .version = "",
                             .commit = ""};
    if (contents.program.empty())
        throw UsageError(
            "no program for the board; ./traction flash --pack builds it, or give --program FILE (a tractiond for its processor)");
    if (contents.start.empty())
        throw std::runtime_error("start: this script of every version is missing beside the program (firmware/flash)");
    const std::string text = version_text(); // "traction 0.2.0 (commit 0123456789)\n"
    const std::size_t blank = text.find(' '), open = text.find(" (commit "), close = text.find(')');
    contents.version = text.substr(blank + 1, open - blank - 1);
    contents.commit = text.substr(open + 9, close - open - 9);
    for (const std::string &in : {a.key, contents.program, contents.rover, a.parameters}) {
        std::error_code none;
        if (!in.empty() && std::filesystem::equivalent(in, a.pack, none))
            throw UsageError("--pack " + a.pack + " would replace what goes into it");
    }
    flash::Signer signer(a.key);
    flash::Summary summary;
    const std::string bytes = flash::pack(contents, signer, summary);
    log::write_file(bytes, a.pack);
    std::printf("%s: %zu bytes, ", a.pack.c_str(), bytes.size());
    tell_package(summary);
    if (signer.left() < 50) std::printf("%s: %u signatures are left\n", a.key.c_str(), signer.left());
    outcome.json = {{"schema", "traction.flash/1"},
                    {"action", "pack"},
                    {"out", a.pack},
                    {"package", package_json(summary)},
                    {"signatures_left", signer.left()}};
}

flash::Summary look(const FlashArguments &a, const std::string &bytes) {
    if (a.key.empty()) return flash::look(a.package, bytes, nullptr);
    const flash::PublicKey key = flash::read_public(a.key);
    return flash::look(a.package, bytes, &key);
}

void image(const FlashArguments &a, Outcome &outcome) {
    if (a.package.empty()) throw UsageError("--image needs the package that goes into it; --pack OUT makes one");
    if (a.key.empty()) throw UsageError("--image needs the key that the board will obey; give --key FILE (the public half is enough)");
    if (std::error_code none; std::filesystem::equivalent(a.key, a.image, none))
        throw UsageError("--image " + a.image + " would replace what goes into it");
    const flash::PublicKey key = flash::read_public(a.key);
    const std::string bytes = flash::bytes_of(a.package);
    const flash::Summary summary = flash::look(a.package, bytes, &key);
    const flash::ImageOptions options{.rover = a.rover.empty() ? "" : sim::read_rover_file(a.rover).name,
                                      .architecture = a.architecture,
                                      .system = a.system,
                                      .mount = a.mount,
                                      .folder = a.folder,
                                      .flash = {.erase_bytes = static_cast<std::uint32_t>(a.erase_kB) * 1024,
                                                .size_bytes = static_cast<std::uint64_t>(a.size_kB) * 1024}};
    const flash::Image made = flash::make_image(a.package, bytes, key, options);
    log::write_file(made.flash.bytes, a.image);
    std::printf("%s: JFFS2, %zu bytes, %u erase blocks of %d kB, %u of them used; %zu files and folders\nSHA-256 %s\n", a.image.c_str(),
                made.flash.bytes.size(), made.flash.blocks, a.erase_kB, made.flash.used_blocks, made.entries, made.sha.c_str());
    tell_package(summary);
    std::printf("for the NOR flash partition that the board mounts at %s: its boot loader erases it and writes this file there, or, on the "
                "board, flashcp %s /dev/mtdN\n",
                a.mount.c_str(), a.image.c_str());
    outcome.json = {{"schema", "traction.flash/1"},
                    {"action", "image"},
                    {"out", a.image},
                    {"package", package_json(summary)},
                    {"image",
                     {{"bytes", made.flash.bytes.size()},
                      {"sha256", made.sha},
                      {"erase_block_bytes", options.flash.erase_bytes},
                      {"blocks", made.flash.blocks},
                      {"blocks_used", made.flash.used_blocks},
                      {"entries", made.entries},
                      {"mount", a.mount},
                      {"folder", a.folder}}}};
}

flash::FlashOptions flash_options(const FlashArguments &a, nlohmann::json &steps) {
    flash::FlashOptions options;
    try {
        options.board = {.host = flash::plain_word("--host", a.host),
                         .user = flash::plain_word("--user", a.user),
                         .identity = a.identity,
                         .known_hosts = a.known_hosts,
                         .program = a.ssh,
                         .port = a.port};
        options.folder = flash::plain_word("--folder", a.folder);
        options.program = flash::plain_word("--installer", a.installer);
    } catch (const std::runtime_error &error) {
        throw UsageError(error.what());
    }
    for (const std::string &file : {a.identity, a.known_hosts})
        if (!file.empty() && !std::filesystem::exists(file))
            throw log::FileError(file, 0, 0, "cannot be read: no such file", "give another");
    options.dry_run = a.dry_run;
    options.wait_s = a.wait_s;
    options.step = [&steps](const std::string &line) {
        std::printf("%s\n", line.c_str());
        std::fflush(stdout);
        steps.push_back(line);
    };
    options.stopped = [] { return StopSignal::asked() != 0; };
    return options;
}

int exit_code_of(flash::Outcome outcome) {
    switch (outcome) {
    case flash::Outcome::confirmed:
    case flash::Outcome::same:
    case flash::Outcome::checked:
    case flash::Outcome::installed:
        return exit_done;
    case flash::Outcome::returned:
    case flash::Outcome::unknown:
        return exit_negative;
    case flash::Outcome::refused:
        return exit_bad_input;
    case flash::Outcome::busy:
    case flash::Outcome::failed:
        break;
    }
    return exit_io;
}

const char *result_words(const flash::Result &result) {
    switch (result.outcome) {
    case flash::Outcome::confirmed:
        return "the new version runs";
    case flash::Outcome::same:
        return "this very version runs already";
    case flash::Outcome::checked:
        return "the board would take it; nothing was written";
    case flash::Outcome::installed:
        return "installed; no version runs there now";
    case flash::Outcome::returned:
        return result.old_version ? "the old version runs; the new one did not come up"
                                  : "the new version did not come up, and the board has no other";
    case flash::Outcome::unknown:
        return "installed, and not yet confirmed";
    case flash::Outcome::refused:
        return "the board refuses it, and was not changed";
    case flash::Outcome::busy:
        return "the board is busy, and was not changed";
    case flash::Outcome::failed:
        break;
    }
    return "not installed; the old version runs";
}

void onto_board(const FlashArguments &a, Outcome &outcome) {
    nlohmann::json steps = nlohmann::json::array();
    const flash::FlashOptions options = flash_options(a, steps);
    outcome.json = {{"schema", "traction.flash/1"}, {"action", a.status ? "status" : "flash"}, {"host", a.host}};
    const StopSignal signals("\ntraction: the board goes on by itself; traction flash --host ADDR --status asks it\n");
    try {
        if (a.status) {
            const flash::Answer answer =
                flash::run_on(options.board, {options.program, "--folder", options.folder, "status"}, "", options.step);
            if (answer.status == 127)
                throw std::runtime_error(a.host + ": " + a.installer + " is not on the board; docs/flash.md tells its first flash");
            if (answer.status != 0) throw std::runtime_error(a.host + ": " + answer.error);
            outcome.json["steps"] = steps;
            return;
        }
        const std::string bytes = flash::bytes_of(a.package);
        const flash::Summary summary = look(a, bytes);
        tell_package(summary);
        outcome.json["package"] = package_json(summary);
        const flash::Result result = flash::flash(options, bytes);
        std::fflush(stdout);
        const std::string text = a.host + ": " + result_words(result) + (result.reason.empty() ? "" : ": " + result.reason);
        outcome.exit_code = exit_code_of(result.outcome);
        std::fprintf(outcome.exit_code == exit_done ? stdout : stderr, "%s%s\n",
                     outcome.exit_code == exit_done ? "" : "traction: ", text.c_str());
        outcome.json["outcome"] = flash::name_of(result.outcome);
        outcome.json["reason"] = result.reason;
        outcome.json["steps"] = steps;
    } catch (const flash::NoConnection &no) {
        throw log::FileError(no.board, 0, 0, no.happened, no.mend);
    }
    if (const int signal = StopSignal::asked(); signal != 0) outcome.exit_code = 128 + signal;
}

void run_flash(const FlashArguments &a, Outcome &outcome) {
    const int asked = (a.new_key.empty() ? 0 : 1) + (a.pack.empty() ? 0 : 1) + (a.host.empty() ? 0 : 1) + (a.image.empty() ? 0 : 1);
    if (asked > 1) throw UsageError("--new-key, --pack, --image and --host are four things; give one");
    if (!a.rover.empty() && a.pack.empty() && a.image.empty()) throw UsageError("--rover goes with --pack or --image");
    if (!a.image.empty()) return image(a, outcome);
    if (!a.new_key.empty()) return make_key(a, outcome);
    if (!a.pack.empty()) return pack(a, outcome);
    if (a.status && a.host.empty()) throw UsageError("--status of which board? give --host ADDR");
    if (a.package.empty() && !a.status) throw UsageError("no PACKAGE; --pack OUT makes one, or give --status");
    if (!a.host.empty()) return onto_board(a, outcome);
    const std::string bytes = flash::bytes_of(a.package);
    const flash::Summary summary = look(a, bytes);
    tell_package(summary);
    std::printf("%s\n", a.key.empty() ? "whether its signature holds: give --key FILE (the public half is enough)"
                                      : "signed by this key, and whole");
    outcome.json = {{"schema", "traction.flash/1"}, {"action", "look"}, {"package", package_json(summary)}, {"verified", !a.key.empty()}};
}

std::vector<Option> image_rows(FlashArguments &a) {
    return {{.name = "--image",
             .into = &a.image,
             .help = "make the contents of a board's NOR flash, with PACKAGE as the version that runs",
             .value = "OUT",
             .kind = Kind::output},
            {.name = "--system",
             .into = &a.system,
             .help = "the board's root file system, which the image then has too",
             .value = "FOLDER",
             .kind = Kind::folder,
             .needs = {"--image"}},
            {.name = "--mount",
             .into = &a.mount,
             .help = "where the board mounts the image; --folder lies below it",
             .value = "FOLDER",
             .shows_default = true,
             .needs = {"--image"}},
            {.name = "--architecture",
             .into = &a.architecture,
             .help = "of the board, Debian's word",
             .value = "WORD",
             .shows_default = true,
             .needs = {"--image"}},
            {.name = "--erase-block",
             .into = &a.erase_kB,
             .help = "of the flash, as /proc/mtd on the board has it (there in bytes, hexadecimal)",
             .value = "kB",
             .shows_default = true,
             .range = Range{8, 4096},
             .needs = {"--image"}},
            {.name = "--size",
             .into = &a.size_kB,
             .help = "of the whole partition: the image is filled up to it; only what it takes when left out",
             .value = "kB",
             .range = Range{1, 4194303},
             .needs = {"--image"}}};
}

std::vector<Option> board_rows(FlashArguments &a) {
    return {
        {.name = "--host", .into = &a.host, .help = "the board's address or name: flash it over ssh", .value = "ADDR"},
        {.name = "--port", .into = &a.port, .help = "of its ssh server", .value = "N", .shows_default = true, .range = Range{1, 65535}},
        {.name = "--user", .into = &a.user, .help = "who may write the slots there", .value = "NAME", .shows_default = true},
        {.name = "--identity", .into = &a.identity, .help = "ssh's private key; ssh's own when left out", .value = "FILE"},
        {.name = "--known-hosts", .into = &a.known_hosts, .help = "host keys, instead of the user's", .value = "FILE"},
        {.name = "--ssh", .into = &a.ssh, .help = "the ssh program", .value = "PROGRAM", .shows_default = true},
        {.name = "--installer", .into = &a.installer, .help = "the board's own program", .value = "NAME", .shows_default = true},
        {.name = "--folder", .into = &a.folder, .help = "of the slots on the board", .value = "FOLDER", .shows_default = true},
        {.name = "--wait",
         .into = &a.wait_s,
         .help = "for the new version to be healthy",
         .value = "S",
         .shows_default = true,
         .range = Range{1, 3600}},
        {.name = "--dry-run", .into = &a.dry_run, .help = "send it, let the board check everything, write nothing", .needs = {"--host"}},
        {.name = "--status", .into = &a.status, .help = "which version runs there, and nothing else"}};
}

} // namespace

Verb verb_flash() {
    const auto arguments = std::make_shared<FlashArguments>();
    FlashArguments &a = *arguments;
    return {
        .name = "flash",
        .summary = "sign a version of the rover's software and put it onto its board, with a way back",
        .options = rows(
            {{.argument = "PACKAGE", .into = &a.package, .help = "to flash with --host, or to look into without", .kind = Kind::input},
             {.name = "--new-key", .into = &a.new_key, .help = "make a signing key, FILE and FILE.pub, and nothing else", .value = "FILE"},
             {.name = "--pack", .into = &a.pack, .help = "make a signed package", .value = "OUT", .kind = Kind::output},
             {.name = "--key", .into = &a.key, .help = "to sign with; or to verify PACKAGE, its public half", .value = "FILE"},
             {.name = "--program",
              .into = &a.program,
              .help = "the board's tractiond; build/korebot's when left out",
              .value = "FILE",
              .needs = {"--pack"}},
             {.name = "--rover",
              .into = &a.rover,
              .help = "the rover's description, with [hardware]; with --image the rover that the package must be for",
              .value = "FILE",
              .kind = Kind::rover},
             {.name = "--parameters",
              .into = &a.parameters,
              .help = "the firmware's numbers (traction export --firmware); the description's when left out",
              .value = "FILE",
              .kind = Kind::input,
              .needs = {"--pack"}}},
            rows(image_rows(a), board_rows(a))),
        .run = [arguments](Outcome &outcome) { run_flash(*arguments, outcome); },
        .details = "The board has two slots. The new version goes into the one that does not run; it is verified, self-tested and tried, "
                   "and only when "
                   "10 s of its ticks were without a fault does it stay. Otherwise the old one runs again, by itself. docs/flash.md has "
                   "the package, "
                   "the board's first flash, the image and what the signature protects from.\n\n"
                   "Exit codes: 1 the new version did not come up, or gave no answer in time; 3 the package is wrong, or refused by the "
                   "board; 4 no "
                   "connection, the board is busy or its disk full."};
}

} // namespace traction::cli
