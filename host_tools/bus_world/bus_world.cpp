#include "bus_world.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

namespace traction::bus_world {

namespace {

std::int64_t clock_ns() {
    timespec now{};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

[[noreturn]] void refuse(const std::string &interface, const std::string &what) {
    throw std::runtime_error("--can " + interface + ": " + what);
}

// A socket is bound to an interface that is down, too, and hears nothing there.
bool is_up(int fd, const std::string &interface) {
    ifreq asked{};
    interface.copy(asked.ifr_name, IFNAMSIZ - 1);
    return ioctl(fd, SIOCGIFFLAGS, &asked) == 0 && (asked.ifr_flags & IFF_UP) != 0;
}

} // namespace

BusWorld::BusWorld(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed)
    : world_(scenario, effects, seed, emulate::Sensors::can, "a CAN bus") {}

std::vector<can_frame_t> BusWorld::hear(std::int64_t now_ns, const can_frame_t *frame) {
    if (!clock_.running() && (frame == nullptr || frame->id != CAN_SYNC)) return {};
    emulate::BoardSays said;
    said.head.version = LOCKSTEP_VERSION;
    said.head.lines = 1u << LOCKSTEP_LINE_MOTOR_ENABLE;
    said.head.time_ns = frame != nullptr && frame->id == CAN_SYNC ? clock_.sync(now_ns) : clock_.at(now_ns);
    if (frame != nullptr) {
        lockstep_frame_t one{.id = frame->id, .length = frame->length, .zero = {}, .data = {}};
        std::memcpy(one.data, frame->data, sizeof one.data);
        said.frames.push_back(one);
        said.head.frames = 1;
    }
    std::vector<can_frame_t> out;
    for (const lockstep_frame_t &answer : world_.hear(said).frames) {
        can_frame_t one{.id = answer.id, .length = answer.length, .data = {}};
        std::memcpy(one.data, answer.data, sizeof one.data);
        out.push_back(one);
    }
    return out;
}

can_socket_t open_bus(const std::string &interface) {
    const int any = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, 1); // CAN_RAW
    if (any < 0 && (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT))
        refuse(interface, "this kernel has no CAN; one with CONFIG_CAN_RAW and CONFIG_CAN_VCAN has (Debian's: modprobe -a can-raw vcan)");
    if (any >= 0) (void)close(any);
    can_socket_t bus{};
    const int result = can_socket_open_nodes(&bus, interface.c_str());
    if (result == -ENODEV)
        refuse(interface, "is no CAN interface of this machine; make one: modprobe vcan; ip link add " + interface +
                              " type vcan; ip link set " + interface + " up");
    if (result != 0) refuse(interface, std::string("cannot be opened: ") + std::strerror(-result));
    if (!is_up(bus.fd, interface)) {
        can_socket_close(&bus);
        refuse(interface, "is down; ip link set " + interface + " up");
    }
    return bus;
}

Run answer(BusWorld &world, can_socket_t &bus, const std::string &interface, const Hooks &hooks) {
    Run run;
    std::uint32_t seconds = 0;
    const auto say = [&](const std::vector<can_frame_t> &frames) {
        for (const can_frame_t &frame : frames) {
            const can_socket_result_t result = can_socket_send(&bus, &frame, clock_ns());
            run.lost += result == CAN_SOCKET_FULL || result == CAN_SOCKET_OFF ? 1u : 0u;
            if (result == CAN_SOCKET_GONE) refuse(interface, "has gone, or is down; ip link set " + interface + " up");
        }
    };
    while (!world.over() && !run.interrupted) {
        pollfd wait{.fd = bus.fd, .events = POLLIN, .revents = 0};
        (void)poll(&wait, 1, 5);
        const bool waited = !world.begun();
        can_frame_t frame;
        can_socket_result_t got = CAN_SOCKET_NOTHING;
        while (!world.over() && (got = can_socket_receive(&bus, &frame)) == CAN_SOCKET_OK) say(world.hear(clock_ns(), &frame));
        if (got == CAN_SOCKET_GONE) refuse(interface, "has gone, or is down; ip link set " + interface + " up");
        say(world.hear(clock_ns(), nullptr));
        if (waited && world.begun() && hooks.begun) hooks.begun();
        for (; world.counts().ticks / 100 > seconds; seconds++)
            if (hooks.after_second) hooks.after_second();
        run.interrupted = hooks.stopped && hooks.stopped();
    }
    run.counts = world.counts();
    return run;
}

} // namespace traction::bus_world
