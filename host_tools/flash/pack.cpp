#include "pack.h"

#include "firmware/app/parameters.h"
#include "firmware/app/trace_text.h"
#include "hal/open.h"
#include "host_tools/log/log.h"
#include "host_tools/loop/loop.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"
#include "sim/scenario/scenario.h"

#include <cstdint>
#include <cstdio>
#include <elf.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace traction::flash {

namespace {

constexpr double check_s = 3.0; // 300 ticks, 24 spectra of the radar: every block has run

struct File {
    std::string name;
    std::uint32_t mode;
    std::string bytes;
};

// The operator of the recorded drive, and the hash over its traces.
class Hashing : public Link {
  public:
    explicit Hashing(hal_opened_t &world) : world_(world) {}
    void command(const sensor_frame_t &frame, command_t &command) override { world_.command(world_.hal.context, &frame, &command); }
    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        char line[TRACE_TEXT];
        trace_text(&trace, line);
        hash = trace_text_hash(hash, line);
    }
    std::uint64_t hash = TRACE_HASH_BEGIN;

  private:
    hal_opened_t &world_;
};

// As tractiond --hal replay --parameters FILE --hash FRAMES prints it.
std::string hash_of(const std::string &frames, const std::string &parameters, const std::string &name) {
    control_config_t config = rover_config_default();
    const auto beam = std::make_unique<doppler_template_t>();
    char refused[PARAMETERS_MESSAGE];
    if (!parameters_parse(parameters.data(), parameters.size(), name.c_str(), &config, beam.get(), refused))
        throw std::runtime_error(refused);
    hal_opened_t world;
    char message[HAL_MESSAGE];
    const char *argument = frames.c_str();
    if (hal_open("replay", 1, &argument, &world, message) < 0) throw std::runtime_error(message);
    Hashing hashing(world);
    const daemon_result_t result = run_loop(world.hal, config, hashing);
    world.close(world.hal.context);
    if (result.ended_by < 0 || result.ticks == 0) throw std::logic_error("the recorded drive does not replay");
    char text[20];
    std::snprintf(text, sizeof text, "%016" PRIx64 "\n", hashing.hash);
    return text;
}

struct Temporary {
    Temporary() : path((std::filesystem::temp_directory_path() / "traction-flash.XXXXXX").string()) {
        if (::mkdtemp(path.data()) == nullptr) throw std::runtime_error(path + ": no folder can be made there: " + std::strerror(errno));
    }
    ~Temporary() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Temporary(const Temporary &) = delete;
    Temporary &operator=(const Temporary &) = delete;
    std::string path;
};

void add(std::string &archive, const std::string &name, std::uint32_t mode, const std::string &bytes) {
    std::uint8_t block[PACKAGE_BLOCK];
    const auto size = static_cast<std::uint32_t>(bytes.size());
    if (!package_header(name.c_str(), mode, size, block)) throw std::logic_error("a name in a package is too long");
    archive.append(reinterpret_cast<const char *>(block), sizeof block);
    archive += bytes;
    archive.append(package_padding(size), '\0');
}

void put_word(char (&to)[PACKAGE_WORD], const std::string &from, const char *what) {
    if (from.empty() || from.size() >= sizeof to) throw std::runtime_error(std::string(what) + " \"" + from + "\": 1 to 79 letters");
    std::memcpy(to, from.c_str(), from.size() + 1);
}

std::string id_text(const std::uint8_t *id) {
    char text[2 * LMS_ID + 1];
    package_hex(id, LMS_ID, text);
    return text;
}

Summary summary_of(const package_t &package, std::size_t bytes) {
    Summary summary{package.version, package.commit, package.architecture, package.rover, id_text(package.key), package.number, bytes, {}};
    for (std::uint32_t i = 0; i < package.count; i++) summary.files.emplace_back(package.file[i].name, package.file[i].size);
    return summary;
}

} // namespace

std::string bytes_of(const std::string &path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    std::string bytes;
    char part[65536];
    ssize_t got = file < 0 ? -1 : 1;
    while (got > 0 && bytes.size() <= PACKAGE_BYTES) {
        got = ::read(file, part, sizeof part);
        if (got > 0) bytes.append(part, static_cast<std::size_t>(got));
    }
    const int error = errno;
    if (file >= 0) ::close(file);
    if (got < 0) throw log::FileError(path, 0, 0, std::string("cannot be read: ") + std::strerror(error), "give a file that is there");
    if (bytes.size() > PACKAGE_BYTES)
        throw log::FileError(path, 0, 0, "is larger than any package (24 MB)", "give a package, or a program for a board");
    return bytes;
}

std::string architecture_of(const std::string &path, const std::string &bytes) {
    Elf32_Ehdr head{};
    if (bytes.size() < sizeof head || std::memcmp(bytes.data(), ELFMAG, SELFMAG) != 0)
        throw std::runtime_error(
            path + ": no program (ELF); give the tractiond that was built for the board: build/korebot/firmware/app/tractiond");
    std::memcpy(&head, bytes.data(), sizeof head); // e_machine is at the same place in 32 and 64 bits; both machines here are little-endian
    if (head.e_machine == EM_ARM) return (head.e_flags & EF_ARM_ABI_FLOAT_HARD) != 0 ? "armhf" : "armel";
    if (head.e_machine == EM_X86_64) return "amd64";
    if (head.e_machine == EM_AARCH64) return "arm64";
    throw std::runtime_error(path + ": a program for a machine that is not known here (ELF machine " + std::to_string(head.e_machine) +
                             ")");
}

std::string pack(const Contents &contents, Signer &signer, Summary &summary) {
    const sim::RoverDescription rover = sim::read_rover_file(contents.rover);
    if (rover.hardware_line == 0)
        throw std::runtime_error(contents.rover + ": no section [hardware]: it says no board which devices it has (docs/hardware.md)");
    std::vector<File> files = {{"tractiond", 0755, bytes_of(contents.program)},
                               {"start", 0755, bytes_of(contents.start)},
                               {"rover.toml", 0644, bytes_of(contents.rover)},
                               {"parameters", 0644, contents.parameters.empty() ? firmware_text(rover) : bytes_of(contents.parameters)}};
    const std::string architecture = architecture_of(contents.program, files[0].bytes);
    const Temporary folder;
    const std::string frames = folder.path + "/check.frames";
    sim::Scenario scenario = sim::read_scenario(contents.check);
    sim::set_rover(scenario, rover);
    scenario.duration_s = check_s;
    SimulateOptions options;
    options.record = false;
    options.frames_path = frames;
    simulate(scenario, options);
    files.push_back({"check.frames", 0644, bytes_of(frames)});
    files.push_back(
        {"check.hash", 0644, hash_of(frames, files[3].bytes, contents.parameters.empty() ? contents.rover : contents.parameters)});

    package_t package{};
    put_word(package.version, contents.version, "version");
    put_word(package.commit, contents.commit, "commit");
    put_word(package.architecture, architecture, "architecture");
    put_word(package.rover, rover.name, "the rover's name");
    std::memcpy(package.key, signer.id(), LMS_ID);
    package.number = signer.next();
    package.count = static_cast<std::uint32_t>(files.size());
    for (std::size_t i = 0; i < files.size(); i++) {
        package_file_t &entry = package.file[i];
        std::memcpy(entry.name, files[i].name.c_str(), files[i].name.size() + 1);
        entry.mode = files[i].mode;
        entry.size = static_cast<std::uint32_t>(files[i].bytes.size());
        sha256(files[i].bytes.data(), files[i].bytes.size(), entry.sha);
    }
    char text[PACKAGE_TEXT];
    const std::string manifest(text, package_print_manifest(&package, text));
    if (manifest.empty())
        throw std::runtime_error(contents.program +
                                 ", or the rover's name: larger than a package may be (24 MB), or not plain ASCII words");
    std::string archive;
    add(archive, "manifest", 0644, manifest);
    add(archive, "manifest.sig", 0644, signer.sign(manifest));
    for (const File &file : files) add(archive, file.name, file.mode, file.bytes);
    archive.append(2 * PACKAGE_BLOCK, '\0');
    summary = summary_of(package, archive.size());
    return archive;
}

Summary look(const std::string &path, const std::string &bytes, const PublicKey *key) {
    package_t package{};
    char message[PACKAGE_MESSAGE];
    PublicKey own{};
    if (key != nullptr) own = *key;
    const package_verdict_t verdict =
        package_read(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size(), own.data(), &package, message);
    if (verdict == PACKAGE_GOOD || (verdict == PACKAGE_FOREIGN && key == nullptr)) return summary_of(package, bytes.size());
    throw std::runtime_error(path + ": " + message);
}

} // namespace traction::flash
