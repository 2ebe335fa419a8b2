#include "token.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace traction::serve {

namespace {

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::size_t length = 43; // of 6 bits

// Empty where the file is none that we would have written.
std::string read_token(const std::string &path) {
    const int fd = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return "";
    struct stat about {};
    std::array<char, length + 1> text{};
    const bool ours = fstat(fd, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == geteuid() && (about.st_mode & 077) == 0;
    const ssize_t got = ours ? read(fd, text.data(), text.size()) : 0;
    close(fd);
    if (got != static_cast<ssize_t>(length)) return "";
    const std::string token(text.data(), length);
    return token.find_first_not_of(letters) == std::string::npos ? token : "";
}

} // namespace

std::string make_token() {
    std::array<std::uint8_t, length> random{};
    if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size()))
        throw std::runtime_error("the kernel gives no random numbers (getrandom): no token can be made");
    std::string token;
    for (const std::uint8_t byte : random) token += letters[byte % 64];
    return token;
}

std::string keep_token(const std::string &path) {
    if (std::string token = read_token(path); !token.empty()) return token;
    const std::string token = make_token();
    unlink(path.c_str());
    const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0) return token;
    const bool whole = write(fd, token.data(), token.size()) == static_cast<ssize_t>(token.size());
    close(fd);
    if (!whole) unlink(path.c_str());
    return token;
}

bool same_token(std::string_view secret, std::string_view given) {
    unsigned differ = secret.size() == given.size() && !secret.empty() ? 0 : 1;
    for (std::size_t i = 0; i < secret.size(); ++i) {
        const char other = given.empty() ? '\0' : given[i % given.size()];
        differ |= static_cast<unsigned char>(secret[i]) ^ static_cast<unsigned char>(other);
    }
    return differ == 0;
}

} // namespace traction::serve
