#include "campaign.h"

#include "answer.h"

#include "host_tools/log/write_file.h"

#include <algorithm>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <thread>

extern char **environ;

namespace traction::bench_lab {

namespace {

namespace fs = std::filesystem;

// largest: what the program may exit with; `traction simulate` says 1 for a drive that ended with a fault, and its log counts.
void run(const std::vector<std::string> &command, int largest = 0) {
    std::vector<char *> arguments;
    std::string line;
    for (const std::string &word : command) {
        arguments.push_back(const_cast<char *>(word.c_str()));
        line += word + " ";
    }
    arguments.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
        throw std::runtime_error("cannot start " + command[0] + "; to mend: build everything (./traction build)");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) > largest) throw std::runtime_error("this failed: " + line);
}

// Runs task(0..count-1) on several threads; the first exception is thrown again here.
void in_parallel(std::size_t count, int jobs, const std::function<void(std::size_t)> &task) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex mutex;
    std::vector<std::thread> threads;
    for (int j = 0; j < std::max(1, jobs); ++j)
        threads.emplace_back([&] {
            for (std::size_t i = next++; i < count; i = next++) {
                try {
                    task(i);
                } catch (...) {
                    const std::lock_guard lock(mutex);
                    if (!failure) failure = std::current_exception();
                    next = count;
                }
            }
        });
    for (std::thread &thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

// Processor time of this thread: what a log costs on one core, whatever else the machine does.
double processor_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string number_word(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

// The soil stands in the log's header: the operator knows the ground he drives on.
std::string soil_of(const std::string &log_file) {
    std::ifstream file(log_file);
    std::string line;
    std::getline(file, line); // the names
    while (std::getline(file, line) && !line.empty() && line[0] == '#')
        if (line.rfind("# soil: ", 0) == 0) return line.substr(8);
    return "sand";
}

void make_independent(const CampaignOptions &options, const std::string &seed, SealedLog &one) {
    std::vector<std::string> command = {options.lab_generate, "--seed", seed, "--seal", one.seal, "--out", one.log};
    if (draws_its_own(options.generator))
        command.push_back("--" + options.generator);
    else
        command.insert(command.end(), {"--blind", "--duration", number_word(options.duration_s)});
    if (options.generator == "apart") command.push_back("--apart");
    if (!options.category.empty()) command.insert(command.end(), {"--category", options.category});
    if (options.generator != "independent") {
        one.model = one.log + ".model.toml";
        command.insert(command.end(), {"--model", one.model});
    }
    run(command);
    one.soil = soil_of(one.log);
    if (one.model.empty()) one.model = campaign_model(options.generator, one.soil);
    if (fs::exists(one.log + ".map.toml")) one.map = one.log + ".map.toml";
}

// The ODE plant on the identification drive: of 20 seeds 3 are clean, 4 hide two effects, 13 one; soil by seed.
void make_plant(const CampaignOptions &options, std::uint64_t seed, SealedLog &one) {
    constexpr const char *soils[] = {"sand", "gravel", "concrete", "sand", "concrete"};
    one.soil = soils[seed % 5];
    one.model = campaign_model(options.generator, one.soil);
    std::ifstream source(options.scenario);
    if (!source.is_open()) throw std::runtime_error("cannot read " + options.scenario);
    std::string text((std::istreambuf_iterator<char>(source)), std::istreambuf_iterator<char>());
    const std::string plain = "soil = \"sand\"";
    const std::size_t at = text.find(plain);
    if (at == std::string::npos) throw std::runtime_error(options.scenario + " has no line: " + plain);
    text.replace(at, plain.size(), "soil = \"" + one.soil + "\"");
    const std::string scenario = options.folder + "/scenario_" + std::to_string(seed) + ".toml";
    log::write_file(text, scenario);
    std::vector<std::string> command = {options.traction,     "simulate", scenario, "--seed",
                                        std::to_string(seed), "--out",    one.log,  "--quiet"};
    const std::uint64_t draw = seed % 20;
    if (draw < 3) {
        log::write_file("{\"schema\": \"traction.seal/1\", \"effects\": []}\n", one.seal);
    } else {
        const std::vector<std::string> hide = {"--hide", std::to_string(seed), "--hide-count", draw < 7 ? "2" : "1", "--seal", one.seal};
        command.insert(command.end(), hide.begin(), hide.end());
    }
    run(command, 1);
}

// The plant's seals keep a unit beside each value and leave out what is usual: brought to the form that the judge reads.
void complete(nlohmann::json &seal, const SealedLog &one) {
    auto &effects = seal["effects"];
    for (auto &effect : effects) {
        if (!effect.contains("wheel")) effect["wheel"] = -1;
        for (auto &[name, value] : effect["parameters"].items())
            if (value.is_object()) value = value.at("value").get<double>();
    }
    if (!seal.contains("soil")) seal["soil"] = one.soil;
    if (!seal.contains("category")) seal["category"] = effects.empty() ? "clean" : effects.size() == 1 ? "one" : "two";
    if (!seal.contains("seed")) seal["seed"] = seal.value("hide_seed", 0);
}

} // namespace

std::vector<SealedLog> make_logs(const CampaignOptions &options) {
    fs::create_directories(options.folder + "/seals");
    std::vector<SealedLog> logs(static_cast<std::size_t>(options.logs));
    in_parallel(logs.size(), options.jobs, [&](std::size_t i) {
        const std::string seed = std::to_string(options.seed + i);
        SealedLog &one = logs[i];
        one.log = options.folder + "/log_" + seed + ".csv";
        one.seal = options.folder + "/seals/seal_" + seed + ".json";
        if (options.generator == "plant")
            make_plant(options, options.seed + i, one);
        else
            make_independent(options, seed, one);
        if (options.step) options.step();
    });
    return logs;
}

void answer_all(std::vector<SealedLog> &logs, const CampaignOptions &options, const Lab &lab) {
    in_parallel(logs.size(), options.jobs, [&](std::size_t i) {
        const double start = processor_s();
        try {
            logs[i].result = lab(logs[i]);
        } catch (const std::exception &error) {
            logs[i].result = {{"error", error.what()}};
        }
        logs[i].seconds = processor_s() - start;
        log::write_file(logs[i].result.dump(1) + '\n', logs[i].log + ".answer.json");
        if (options.step) options.step();
    });
}

std::vector<Judged> open_seals(const std::vector<SealedLog> &logs) {
    std::vector<Judged> judged;
    for (const SealedLog &one : logs) {
        std::ifstream file;
        file.exceptions(std::ios::failbit | std::ios::badbit);
        file.open(one.seal);
        nlohmann::json seal = nlohmann::json::parse(file);
        complete(seal, one);
        judged.push_back({fs::path(one.log).filename().string(), seal, one.result, one.seconds});
    }
    return judged;
}

void add_floors(std::vector<Judged> &judged, const std::vector<SealedLog> &logs, const CampaignOptions &options, const Floor &floor) {
    in_parallel(judged.size(), options.jobs, [&](std::size_t i) {
        if (judged[i].result.contains("error") || judged[i].seal.at("effects").empty()) return;
        const TruthFit fit = floor(logs[i], judged[i].seal);
        if (fit.floor > 0) judged[i].result["floor_with_truth"] = fit.floor;
        if (fit.floor > 0) judged[i].result["detectability_with_truth"] = fit.detectability;
        if (options.step) options.step();
    });
}

} // namespace traction::bench_lab
