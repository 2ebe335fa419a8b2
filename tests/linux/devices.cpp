#include "devices.h"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <linux/can.h>
#include <linux/gpio.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace traction::devices {

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "traction_linux_XXXXXX").string();
    path_ = mkdtemp(name.data());
}
Folder::~Folder() { std::filesystem::remove_all(path_); }

void Folder::put(const std::string &name, const std::string &text) const {
    const std::filesystem::path file = std::filesystem::path(path_) / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

std::string Folder::get(const std::string &name) const {
    std::ifstream file(std::filesystem::path(path_) / name);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    return text.substr(0, text.find('\n')); // what was longer before stays behind the newline in a plain file
}

void Folder::fifo(const std::string &name) const {
    const std::filesystem::path file = std::filesystem::path(path_) / name;
    std::filesystem::create_directories(file.parent_path());
    if (mkfifo(file.c_str(), 0600) != 0) std::abort();
}

Lines &lines() {
    static Lines all;
    return all;
}

namespace {

int refuse(int error) {
    errno = error;
    return -1;
}

int take(std::uint32_t offset, bool active_low, bool output, std::int32_t *out) {
    Lines &all = lines();
    if (offset > 31) return refuse(EINVAL);
    if (all.taken[offset]) return refuse(EBUSY);
    *out = open("/dev/null", O_RDWR | O_CLOEXEC);
    all.offset[*out] = offset;
    all.active_low[*out] = active_low;
    if (output) all.level[offset] = active_low ? 1 : 0;
    return 0;
}

int level(int fd) { return lines().level[lines().offset.at(fd)] ^ (lines().active_low.at(fd) ? 1 : 0); }

void set(int fd, int value) {
    Lines &all = lines();
    all.level[all.offset.at(fd)] = value ^ (all.active_low.at(fd) ? 1 : 0);
    all.written.emplace_back(all.offset.at(fd), value);
}

} // namespace

int line_call(int fd, unsigned long request, void *argument) {
    const bool new_kind =
        request == GPIO_V2_GET_LINE_IOCTL || request == GPIO_V2_LINE_GET_VALUES_IOCTL || request == GPIO_V2_LINE_SET_VALUES_IOCTL;
    if (new_kind != (lines().version == 2)) return refuse(EINVAL); // what a kernel says of a call that it lacks
    switch (request) {
    case GPIO_V2_GET_LINE_IOCTL: {
        auto *r = static_cast<gpio_v2_line_request *>(argument);
        return take(r->offsets[0], (r->config.flags & GPIO_V2_LINE_FLAG_ACTIVE_LOW) != 0, (r->config.flags & GPIO_V2_LINE_FLAG_OUTPUT) != 0,
                    &r->fd);
    }
    case GPIO_GET_LINEHANDLE_IOCTL: {
        auto *r = static_cast<gpiohandle_request *>(argument);
        return take(r->lineoffsets[0], (r->flags & GPIOHANDLE_REQUEST_ACTIVE_LOW) != 0, (r->flags & GPIOHANDLE_REQUEST_OUTPUT) != 0,
                    &r->fd);
    }
    case GPIO_V2_LINE_GET_VALUES_IOCTL:
        static_cast<gpio_v2_line_values *>(argument)->bits = static_cast<unsigned>(level(fd));
        return 0;
    case GPIOHANDLE_GET_LINE_VALUES_IOCTL:
        static_cast<gpiohandle_data *>(argument)->values[0] = static_cast<std::uint8_t>(level(fd));
        return 0;
    case GPIO_V2_LINE_SET_VALUES_IOCTL:
        set(fd, static_cast<int>(static_cast<gpio_v2_line_values *>(argument)->bits & 1u));
        return 0;
    case GPIOHANDLE_SET_LINE_VALUES_IOCTL:
        set(fd, static_cast<gpiohandle_data *>(argument)->values[0]);
        return 0;
    default:
        return refuse(ENOTTY);
    }
}

std::array<int, 2> wire() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) std::abort();
    return ends;
}

void say(int fd, std::uint32_t id, const std::vector<std::uint8_t> &data) {
    can_frame raw{};
    raw.can_id = id;
    raw.can_dlc = static_cast<std::uint8_t>(data.size());
    std::memcpy(raw.data, data.data(), data.size());
    if (send(fd, &raw, sizeof raw, MSG_NOSIGNAL) < 0) return; // the other end has gone
}

Nodes::Nodes(int fd) : fd_(fd), thread_([this] { run(); }) {}
Nodes::~Nodes() {
    over_ = true;
    thread_.join();
    close(fd_);
}

namespace {
std::uint32_t now_ms() {
    return static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch()).count());
}
} // namespace

void Nodes::run() {
    std::array<wheel_node_state_t, WHEEL_COUNT> wheel{};
    std::uint32_t radar = 0;
    while (!over_) {
        pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
        if (poll(&wait, 1, 2) <= 0) continue;
        can_frame raw{};
        if (recv(fd_, &raw, sizeof raw, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof raw)) {
            if ((wait.revents & POLLHUP) != 0) return;
            continue;
        }
        can_frame_t frame{.id = raw.can_id, .length = raw.can_dlc, .data = {}};
        std::memcpy(frame.data, raw.data, sizeof frame.data);
        const auto answer_with = [this](const can_frame_t *answer, std::size_t count) {
            for (std::size_t n = 0; n < count; n++) say(fd_, answer[n].id, {answer[n].data, answer[n].data + answer[n].length});
        };
        bool off = true;
        for (std::uint8_t i = 0; i < WHEEL_COUNT; i++) {
            can_frame_t answer[WHEEL_NODE_ANSWERS];
            const wheel_node_config_t config{i, 0};
            const wheel_node_input_t input{100 * i, static_cast<std::uint16_t>(2048 + i), 0};
            const std::size_t count = wheel_node_receive(&config, &wheel[i], now_ms(), &input, &frame, answer);
            if ((silent & 1u << i) == 0) answer_with(answer, count);
            off = off && wheel[i].drive == DRIVE_OFF; // as ordered last; nothing here lets go by itself
        }
        all_off = off;
        if (frame.id == CAN_ORDER) last_duty_0 = wheel[0].duty_q15;
        orders += frame.id >= CAN_ORDER && frame.id - CAN_ORDER < WHEEL_COUNT ? 1 : 0;
        sensor_frame_t devices{};
        devices.present = FRAME_ALL;
        devices.battery_count = 1800;
        devices.radar_samples = 5;
        devices.radar_sequence = radar;
        can_frame_t answer[SENSOR_NODE_ANSWERS];
        const std::size_t count = sensor_node_receive(&devices, &frame, answer);
        if (count > 0) radar += 5;
        if ((silent & 16u) == 0) answer_with(answer, count);
    }
}

} // namespace traction::devices
