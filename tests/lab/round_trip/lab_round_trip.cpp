// lab_round_trip plant|independent|apart [FIRST LAST [SECONDS]] [--row | --judge FILE] - the whole round trip, a table for
// docs/lab_benchmark.md. Run in the project's folder. Exit 1 where intervals of all parameters, or of all effects, do not hold the truth in
// 0.92 to 0.98 of the cases, within the error of the sample.
//
// --row: the estimates as one line of JSON on standard output, {"estimates": [{log, key, truth, value, low, high, inside}], "seconds": CPU
// time}, and exit 0. --judge FILE: the table of such lines, nothing is driven (docs/campaign.md).
#include "round_trip.h"

#include <nlohmann/json.hpp>

#include <sys/prctl.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace traction::round_trip;

struct Request {
    const char *name = "";
    Source source = Source::independent;
    long first = 1, last = 100;
    double duration_s = 120;
    bool row = false;
    std::string judge;
};

// False where the command line cannot be meant.
bool read_request(std::vector<const char *> words, Request &request) {
    constexpr std::pair<const char *, Source> sources[] = {
        {"independent", Source::independent}, {"apart", Source::apart}, {"plant", Source::plant}};
    if (words.size() >= 2 && std::strcmp(words.back(), "--row") == 0) {
        request.row = true;
        words.pop_back();
    } else if (words.size() >= 3 && std::strcmp(words[words.size() - 2], "--judge") == 0) {
        request.judge = words.back();
        words.resize(words.size() - 2);
    }
    if (words.empty() || words.size() > 4 || words.size() == 2) return false;
    const auto *source =
        std::find_if(std::begin(sources), std::end(sources), [&](const auto &one) { return std::strcmp(words[0], one.first) == 0; });
    if (source == std::end(sources)) return false;
    request.name = source->first;
    request.source = source->second;
    if (words.size() >= 3) request.first = std::atol(words[1]), request.last = std::atol(words[2]);
    if (words.size() >= 4) request.duration_s = std::atof(words[3]);
    return request.first >= 1 && request.last >= request.first && request.duration_s >= 20;
}

std::vector<Estimate> run_all(const Request &request) {
    std::vector<Estimate> all;
    for (long seed = request.first; seed <= request.last; ++seed) {
        const std::vector<Estimate> one = run(request.source, static_cast<std::uint64_t>(seed), request.duration_s);
        all.insert(all.end(), one.begin(), one.end());
        if (request.row) continue;
        int inside = 0;
        for (const Estimate &e : one) inside += e.inside();
        std::fprintf(stderr, "seed %ld: %s, %d of %zu inside\n", seed, one.back().key.c_str(), inside, one.size());
    }
    return all;
}

int print_row(const Request &request) {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // whoever asked is gone: nobody would read the answer
    nlohmann::json row = {{"estimates", nlohmann::json::array()}};
    for (const Estimate &e : run_all(request)) row["estimates"].push_back(estimate_json(e));
    row["seconds"] = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    std::printf("%s\n", row.dump().c_str());
    return 0;
}

std::vector<Estimate> read_rows(const std::string &file) {
    std::ifstream lines(file);
    if (!lines) throw std::runtime_error("cannot open " + file);
    std::vector<Estimate> all;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        try {
            const nlohmann::json row = nlohmann::json::parse(line);
            for (const nlohmann::json &estimate : row.at("estimates")) all.push_back(read_estimate(estimate));
        } catch (const nlohmann::json::exception &error) {
            throw std::runtime_error(file + ":" + std::to_string(number) + ": is no row of the round trip (" + error.what() +
                                     "); to mend: give what --row wrote");
        }
    }
    if (all.empty()) throw std::runtime_error(file + ": holds no estimate");
    return all;
}

} // namespace

int main(int count, char **arguments) {
    Request request;
    if (!read_request({arguments + 1, arguments + count}, request)) {
        std::fprintf(stderr, "usage: lab_round_trip plant|independent|apart [FIRST LAST [SECONDS]] [--row | --judge FILE]   "
                             "1 <= FIRST <= LAST, SECONDS >= 20\n");
        return 2;
    }
    try {
        if (request.row) return print_row(request);
        const std::map<std::string, Tally> tallies = tally(request.judge.empty() ? run_all(request) : read_rows(request.judge));
        std::printf("%s, seeds %ld to %ld, %.0f s each\n\n%s", request.name, request.first, request.last, request.duration_s,
                    table(tallies).c_str());
        return tallies.at("all parameters").as_claimed() && tallies.at("all effects").as_claimed() ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_round_trip: %s\n", error.what());
        return 3;
    }
}
