#include "signing_key.h"

#include "firmware/flash/package.h"
#include "host_tools/log/write_file.h"

#include <algorithm>
#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace traction::flash {

namespace {

constexpr const char *format = "traction-signing-key 1";

std::string hex(const std::uint8_t *bytes, std::size_t length) {
    std::string text(2 * length + 1, '\0');
    package_hex(bytes, length, text.data());
    text.pop_back();
    return text;
}

void random_bytes(std::uint8_t *bytes, std::size_t length) {
    if (::getrandom(bytes, length, 0) != static_cast<ssize_t>(length))
        throw std::runtime_error("the kernel gave no random numbers; try again");
}

[[noreturn]] void fail(const std::string &path, const std::string &mend) {
    throw log::FileError(path, 0, 0, std::string("cannot be written: ") + std::strerror(errno), mend);
}

// A file of these bytes on the disk, mode as given; a new one, or instead of the old.
void write_new(const std::string &path, const std::string &text, mode_t mode) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
    if (file < 0) fail(path, errno == EEXIST ? "a key is never overwritten: give another name" : "is the folder there, and yours?");
    const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(file) == 0;
    const int error = errno;
    if (::close(file) == 0 && written) return;
    ::unlink(path.c_str());
    errno = error;
    fail(path, "is the disk full?");
}

void sync_folder_of(const std::string &path) {
    const std::filesystem::path parent = std::filesystem::absolute(path).parent_path();
    const int folder = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = folder >= 0 && ::fsync(folder) == 0;
    if (folder >= 0) ::close(folder);
    if (!synced) fail(parent.string(), "the key's folder must be on a disk that can be synced");
}

std::string text_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file.is_open() || file.bad()) throw log::FileError(path, 0, 0, "cannot be read", "traction flash --new-key FILE makes a key");
    return text;
}

struct KeyFile {
    lms_secret_t secret{};
    std::uint32_t next = 0;
};

std::string print(const KeyFile &file) {
    return std::string(format) + "\nid " + hex(file.secret.id, LMS_ID) + "\nseed " + hex(file.secret.seed, SHA256_BYTES) + "\nnext " +
           std::to_string(file.next) + "\n";
}

KeyFile parse(const std::string &path, const std::string &text) {
    KeyFile file;
    file.secret.tree = LMS_TREE_OURS;
    file.secret.once = LMS_ONCE_OURS;
    std::string id, seed, word[3];
    std::istringstream in(text.substr(std::min(text.size(), std::strlen(format))));
    in >> word[0] >> id >> word[1] >> seed >> word[2] >> file.next;
    const bool good = id.size() == 2 * LMS_ID && seed.size() == 2 * SHA256_BYTES && package_unhex(id.c_str(), LMS_ID, file.secret.id) &&
                      package_unhex(seed.c_str(), SHA256_BYTES, file.secret.seed);
    if (!good || print(file) != text)
        throw std::runtime_error(path + ": no signing key, or it was changed; traction flash --new-key FILE makes one");
    return file;
}

PublicKey grow(const lms_secret_t &secret, std::vector<std::array<std::uint8_t, SHA256_BYTES>> &nodes) {
    PublicKey key{};
    nodes.resize(std::size_t{2} << LMS_OURS_HEIGHT);
    if (!lms_grow(&secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes.data()), key.data()))
        throw std::logic_error("no tree of this type");
    return key;
}

} // namespace

PublicKey make_key(const std::string &path) {
    KeyFile file;
    file.secret.tree = LMS_TREE_OURS;
    file.secret.once = LMS_ONCE_OURS;
    random_bytes(file.secret.id, LMS_ID);
    random_bytes(file.secret.seed, SHA256_BYTES);
    std::vector<std::array<std::uint8_t, SHA256_BYTES>> nodes;
    const PublicKey key = grow(file.secret, nodes);
    write_new(path, print(file), 0600);
    try {
        write_new(path + ".pub", hex(key.data(), key.size()) + "\n", 0644);
    } catch (...) {
        ::unlink(path.c_str()); // half a key helps nobody
        throw;
    }
    sync_folder_of(path);
    return key;
}

PublicKey read_public(const std::string &path) {
    const std::string text = text_of(path);
    PublicKey key{};
    if (text.size() == 2 * key.size() + 1 && text.back() == '\n' && package_unhex(text.c_str(), key.size(), key.data())) return key;
    std::vector<std::array<std::uint8_t, SHA256_BYTES>> nodes;
    return grow(parse(path, text).secret, nodes);
}

Signer::Signer(const std::string &path) : path_(path) {
    struct stat about {};
    const std::string text = text_of(path);
    if (::stat(path.c_str(), &about) != 0 || (about.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw std::runtime_error(path + ": others may read the key; chmod 600 " + path + ", and make a new key if they did");
    const KeyFile file = parse(path, text);
    secret_ = file.secret;
    next_ = file.next;
    if (left() == 0)
        throw std::runtime_error(path + ": its " + std::to_string(1u << LMS_OURS_HEIGHT) +
                                 " signatures are used up; make a new key, and give it to the rover with traction-slot init");
    key_ = grow(secret_, nodes_);
}

std::uint32_t Signer::left() const { return next_ < (1u << LMS_OURS_HEIGHT) ? (1u << LMS_OURS_HEIGHT) - next_ : 0; }

void Signer::write() const {
    const std::string temporary = path_ + ".new." + std::to_string(::getpid());
    write_new(temporary, print({.secret = secret_, .next = next_}), 0600);
    if (::rename(temporary.c_str(), path_.c_str()) != 0) {
        const int error = errno;
        ::unlink(temporary.c_str());
        errno = error;
        fail(path_, "may its folder be written to?");
    }
    sync_folder_of(path_);
}

std::string Signer::sign(const std::string &message) {
    const log::Claim claim(path_); // one signer at a time
    if (parse(path_, text_of(path_)).next != next_)
        throw std::runtime_error(path_ + ": another traction has signed meanwhile; run this again");
    const std::uint32_t q = next_;
    std::uint8_t random[SHA256_BYTES];
    random_bytes(random, sizeof random);
    std::string signature(LMS_SIGNATURE, '\0');
    auto *const out = reinterpret_cast<std::uint8_t *>(signature.data());
    const auto tree = reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes_.data());
    next_++;
    write(); // before the signature leaves
    signature.resize(lms_sign(&secret_, tree, q, random, message.data(), message.size(), out));
    return signature;
}

} // namespace traction::flash
