#include "image.h"

#include "file_tree.h"

#include "firmware/flash/sha256.h"
#include "firmware/flash/slots.h"

#include <sys/stat.h>

#include <stdexcept>

namespace traction::flash {

namespace {

const std::string starter = "usr/sbin/traction-slot";

// A folder of the board as a path within the image.
std::string within(const ImageOptions &options) {
    std::string mount = options.mount, folder = options.folder;
    while (!mount.empty() && mount.back() == '/') mount.pop_back();
    while (!folder.empty() && folder.back() == '/') folder.pop_back();
    if (folder.compare(0, mount.size() + 1, mount + '/') != 0 || (options.mount[0] != '/') ||
        (folder + '/').find("/../") != std::string::npos || folder.find("//") != std::string::npos)
        throw std::runtime_error("the slots' folder " + options.folder + " does not lie below " + options.mount +
                                 ", where the board mounts the image; give both as whole paths (--folder, --mount)");
    return folder.substr(mount.size() + 1);
}

FileTree system_of(const ImageOptions &options, const std::string &slots) {
    if (options.system.empty()) return {};
    FileTree tree = read_tree(options.system);
    const auto found = tree.find(starter);
    if (found == tree.end() || !S_ISREG(found->second.mode))
        throw std::runtime_error(options.system + ": no /" + starter +
                                 ", and nothing would start a version; copy build/korebot/firmware/flash/" +
                                 "traction-slot there (docs/flash.md)");
    const std::string architecture = architecture_of(options.system + '/' + starter, found->second.bytes);
    if (architecture != options.architecture)
        throw std::runtime_error(options.system + '/' + starter + ": for the architecture " + architecture + ", the image is for " +
                                 options.architecture + "; give a system of this one");
    if (tree.count(slots) != 0)
        throw std::runtime_error(options.system + '/' + slots + ": the system has slots already; remove them, the image gets its own");
    add_folder(tree, "dev");
    tree.try_emplace("dev/console", TreeNode{.mode = S_IFCHR | 0600, .bytes = {}, .device = 5u << 8 | 1u}); // who is not root unpacks none
    return tree;
}

// The board's installer, at the desk. Its self-test needs the board's processor, so it is for the board: `traction-slot status` after the
// boot.
void install(FileTree &tree, const std::string &slots_path, const std::string &path, const std::string &bytes, const PublicKey &key,
             const ImageOptions &options) {
    TreeStorage disk(tree, std::uint64_t{1} << 40); // what fits, the geometry says
    const std::string folder = '/' + slots_path;
    const slots_t slots = {.storage = disk.storage(),
                           .folder = folder.c_str(),
                           .architecture = options.architecture.c_str(),
                           .self_test = [](void *, const char *, char *) { return 0; },
                           .context = nullptr,
                           .step = nullptr};
    char message[PACKAGE_MESSAGE] = "";
    const std::string rover = options.rover.empty() ? look(path, bytes, &key).rover : options.rover;
    slots_result_t result = slots_init(&slots, key.data(), rover.c_str(), message);
    if (result == SLOTS_DONE)
        result = slots_install(&slots, reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size(), false, message);
    if (result == SLOTS_DONE) result = slots_confirm(&slots, message);
    if (result != SLOTS_DONE) throw std::runtime_error(path + ": " + message);
    add_folder(tree, slots_path + "/b");
}

} // namespace

Image make_image(const std::string &path, const std::string &bytes, const PublicKey &key, const ImageOptions &options) {
    const std::string slots = within(options);
    FileTree tree = system_of(options, slots);
    add_folder(tree, slots);
    install(tree, slots, path, bytes, key, options);
    Image image{.flash = jffs2_image(tree, options.flash, bytes.size()), .entries = tree.size(), .sha = {}};
    std::uint8_t sha[SHA256_BYTES];
    char hex[2 * SHA256_BYTES + 1];
    sha256(image.flash.bytes.data(), image.flash.bytes.size(), sha);
    package_hex(sha, SHA256_BYTES, hex);
    image.sha = hex;
    return image;
}

} // namespace traction::flash
