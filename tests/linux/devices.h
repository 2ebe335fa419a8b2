// devices.h - made-up devices for tests of hal/linux: a folder that looks like /sys and /dev, GPIO lines, nodes at the other end of a
// socket.
#pragma once

#include "hal/linux/linux_hal.h"
#include "hal/node/sensor_node.h"
#include "hal/node/wheel_node.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace traction::devices {

// A temporary folder, gone with this object.
class Folder {
  public:
    Folder();
    ~Folder();
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;
    void put(const std::string &name, const std::string &text) const;
    std::string get(const std::string &name) const; // without the newline at its end
    void fifo(const std::string &name) const;
    const std::string &path() const { return path_; }

  private:
    std::string path_;
};

// What the kernel's GPIO calls do, version 2 or 1. One chip at a time: the calls carry no context.
struct Lines {
    int version = 2;
    std::map<std::uint32_t, int> level;  // of the wire, by offset
    std::map<std::uint32_t, bool> taken; // by somebody else: EBUSY
    std::map<int, std::uint32_t> offset; // by descriptor
    std::map<int, bool> active_low;
    std::vector<std::pair<std::uint32_t, int>> written;
};
Lines &lines();
int line_call(int fd, unsigned long request, void *argument);

// Four wheel nodes and a sensor node that answer on a datagram socket as on a bus, in a thread.
class Nodes {
  public:
    explicit Nodes(int fd);
    ~Nodes();
    Nodes(const Nodes &) = delete;
    Nodes &operator=(const Nodes &) = delete;
    std::atomic<unsigned> silent{0};            // bit i: wheel node i; bit 4: the sensor node
    std::atomic<bool> all_off{true};            // every wheel's last order was DRIVE_OFF
    std::atomic<int> orders{0}, last_duty_0{0}; // of wheel 0's last order, released or not

  private:
    void run();
    int fd_;
    std::atomic<bool> over_{false};
    std::thread thread_;
};

// Two ends of such a bus.
std::array<int, 2> wire();
void say(int fd, std::uint32_t id, const std::vector<std::uint8_t> &data); // any struct can_frame, error frames too

} // namespace traction::devices
