// verb_man.cpp - traction man [VERB]: the manual pages, from the verbs' tables.
#include "shell_text.h"
#include "verbs.h"

#include "host_tools/log/write_file.h"
#include "host_tools/suggest/suggest.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct ManRequest {
    std::vector<std::string> verb;
    std::string folder;
};

void man(const ManRequest &request, Outcome &outcome) {
    outcome.json = {{"schema", "traction.man/1"}};
    if (!request.folder.empty()) {
        log::write_file(manual(), request.folder + "/traction.1");
        for (const Verb &verb : all_verbs()) {
            std::string name = verb.name;
            std::replace(name.begin(), name.end(), ' ', '-');
            log::write_file(manual(verb), request.folder + "/traction-" + name + ".1");
        }
        outcome.json["folder"] = request.folder;
        return;
    }
    std::string name, text;
    std::vector<std::string> known;
    for (const std::string &word : request.verb) name += (name.empty() ? "" : " ") + word;
    if (name.empty()) text = manual();
    for (const Verb &verb : all_verbs()) {
        if (verb.name == name) text = manual(verb);
        known.push_back(verb.name);
    }
    if (text.empty()) throw UsageError("there is no verb '" + name + "'" + did_you_mean(name, known, "traction --help"));
    std::fputs(text.c_str(), stdout);
    outcome.json["text"] = text;
}

} // namespace

Verb verb_man() {
    const auto request = std::make_shared<ManRequest>();
    return {.name = "man",
            .summary = "print a manual page; read it with: traction man VERB | man -l -",
            .options = {{.argument = "VERB",
                         .into = &request->verb,
                         .help = "whose page; the overview when left out",
                         .kind = Kind::verb,
                         .at_most = 2},
                        {.name = "--folder",
                         .into = &request->folder,
                         .help = "write every page into this folder",
                         .value = "FOLDER",
                         .kind = Kind::folder}},
            .run = [request](Outcome &outcome) { man(*request, outcome); }};
}

} // namespace traction::cli
