#include "campaign_program.h"

#include "bench_program.h"
#include "data_files.h"
#include "stop_signal.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace traction::cli {

namespace {

constexpr int no_package = 69; // EX_UNAVAILABLE

// Says so with its own exit code where the package, or what campaigns need beside it, is not there.
constexpr const char *script = R"(import sys
try:
    import pyarrow, scipy
    from traction.campaigns.__main__ import main
except ImportError as error:
    print(f"traction: campaign: {sys.executable}: {error}", file=sys.stderr)
    sys.exit(69)
sys.exit(main(sys.argv[1:]))
)";

// $TRACTION_PYTHON, the .venv beside scenarios/, or the system's.
std::string interpreter() {
    if (const char *given = std::getenv("TRACTION_PYTHON"); given != nullptr && *given != '\0') return given;
    const std::filesystem::path own = data_root() / ".venv" / "bin" / "python";
    return std::filesystem::exists(own) ? own.string() : "/usr/bin/python3";
}

// The programs of a bench of the lab are those of this one's build folder, unless another is named.
void name_build() {
    const std::filesystem::path build = std::filesystem::path(own_program()).parent_path() / ".." / "..";
    if (std::filesystem::exists(build / "CMakeCache.txt")) setenv("TRACTION_BUILD", std::filesystem::weakly_canonical(build).c_str(), 0);
}

} // namespace

void run_campaign(std::vector<std::string> arguments, const std::string &json_option, Outcome &outcome) {
    const std::filesystem::path json = std::filesystem::temp_directory_path() / ("traction_campaign_" + std::to_string(getpid()) + ".json");
    const std::string program = interpreter();
    arguments.insert(arguments.begin(), {program, "-c", script, json_option, json.string()});
    std::fflush(stdout);
    name_build();
    {
        const StopSignal stop; // Ctrl-C is the campaign's, which ends in order
        outcome.exit_code = run_program(program, arguments);
    }
    if (std::ifstream file(json); file) outcome.json = nlohmann::json::parse(file, nullptr, false);
    std::filesystem::remove(json);
    if (outcome.exit_code != no_package) return;
    std::fprintf(stderr, "traction: campaign: is the Python package's; to mend: python3 -m venv .venv && .venv/bin/pip install "
                         "'./python[campaign]' in Traction's folder, or name an interpreter that has it in $TRACTION_PYTHON\n");
    outcome.exit_code = exit_io;
}

} // namespace traction::cli
