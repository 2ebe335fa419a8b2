// traction recover PART --out LOG: a whole log of what a run had written when it was killed, or the power went.
#include "verbs.h"

#include "host_tools/log/recover.h"

#include <cstdio>
#include <memory>
#include <string>

namespace traction::cli {

namespace {

struct RecoverOptions {
    std::string part, out;
};

void run_recover(const RecoverOptions &options, Outcome &outcome) {
    const log::Recovered done = log::recover(options.part, options.out);
    const auto lost = static_cast<unsigned long long>(done.lost_bytes), at = static_cast<unsigned long long>(done.lost_at);
    if (!done.damage.empty())
        std::printf("DAMAGED: the block at byte %llu of %s: %s; it and what follows, %llu bytes, are not in the log\n", at,
                    options.part.c_str(), done.damage.c_str(), lost);
    else if (lost > 0)
        std::printf("%llu bytes at the end are of a block that was being written; they are not in the log\n", lost);
    std::printf("%s: %llu samples up to %.6g s, `ended: interrupted` in its header; %s may be removed\n", options.out.c_str(),
                static_cast<unsigned long long>(done.samples), done.last_s, options.part.c_str());
    outcome.json = {{"schema", "traction.recover/1"}, {"in", options.part},    {"out", options.out},
                    {"samples", done.samples},        {"last_s", done.last_s}, {"lost_at", done.lost_at},
                    {"lost_bytes", done.lost_bytes},  {"damage", done.damage}};
    if (!done.damage.empty()) outcome.exit_code = exit_negative;
}

} // namespace

Verb verb_recover() {
    const auto options = std::make_shared<RecoverOptions>();
    return {.name = "recover",
            .summary = "make the log of a run that was killed, from the LOG.part that it left",
            .options = {{.argument = "PART",
                         .into = &options->part,
                         .help = "what lies beside the place of the log: LOG.part",
                         .kind = Kind::log,
                         .required = true},
                        {.name = "--out",
                         .into = &options->out,
                         .help = "the log to write, CSV; ULog where it ends in .ulg",
                         .value = "LOG",
                         .kind = Kind::output,
                         .required = true}},
            .run = [options](Outcome &outcome) { run_recover(*options, outcome); },
            .details = "A run keeps what it has in LOG.part until its log is written, and removes it then. Whatever ends the run before, a "
                       "signal that it cannot answer or a power cut, leaves it: the log made of it is whole up to the last block that was "
                       "written, and says `ended: interrupted`. Exit code 1: a block is damaged, and what follows it is lost."};
}

} // namespace traction::cli
