// hal/linux on made-up devices: what is above a file descriptor is the rover's own code; what is below, only a kernel with the devices
// shows.
#include "devices.h"

#include "hal/linux/sysfs.h"
#include "hal/linux/watchdog.h"

#include <array>
#include <cstdint>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

using namespace traction::devices;

namespace {

const std::string can_rover =
    "# a rover\n[body]\nmass_kg = 2\nunknown here = fine\n[hardware]\nwheels = \"can\"   # nodes\nsensors = \"can\"\n"
    "emergency_stop = \"gpio\"\ncan_interface = \"can7\"\ngpio_chip = \"gpiochip0\"\nemergency_stop_line = 4\n"
    "emergency_stop_active = \"low\"\nemergency_stop_present_line = 5\nmotor_enable_line = 6\nbrake_line = 7\nled_line = 8\n"
    "watchdog = \"watchdog0\"\n";

hardware_t hardware_of(const std::string &text) {
    hardware_t hardware;
    char message[HARDWARE_MESSAGE];
    EXPECT_TRUE(hardware_parse(text.data(), text.size(), "rover.toml", &hardware, message)) << message;
    return hardware;
}

std::string refused(const std::string &text) {
    hardware_t hardware;
    char message[HARDWARE_MESSAGE];
    EXPECT_FALSE(hardware_parse(text.data(), text.size(), "rover.toml", &hardware, message));
    return message;
}

std::string replaced(std::string text, const std::string &what, const std::string &by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string whole(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A rover on the bus with its lines, a watchdog and nodes that answer.
struct Rover {
    Folder folder;
    std::array<int, 2> ends = wire();
    Nodes nodes{ends[1]};
    linux_hal_t devices{};
    hal_t hal{};
    explicit Rover(const std::string &text = can_rover) {
        lines() = {};
        lines().level[4] = 1; // active low: not pressed
        lines().level[5] = 1; // its cable is there
        folder.put("dev/gpiochip0", "");
        folder.put("dev/watchdog0", "");
        const hardware_t hardware = hardware_of(text);
        linux_hal_begin(&devices, &hardware, folder.path().c_str());
        devices.chip.ioctl = line_call;
        can_socket_adopt(&devices.bus, ends[0]);
        hal = linux_hal(&devices);
    }
    sensor_frame_t tick(hal_result_t expected = HAL_OK) {
        EXPECT_EQ(hal.wait_tick(hal.context), HAL_OK);
        sensor_frame_t frame{};
        EXPECT_EQ(hal.read(hal.context, &frame), expected);
        return frame;
    }
};

// On a loaded machine the nodes' thread may be late: asked for at most two seconds.
template <typename Condition> bool soon(Condition condition) {
    for (int i = 0; i < 2000 && !condition(); i++) usleep(1000);
    return condition();
}

constexpr std::uint32_t all_but_bits(std::uint32_t bits) { return FRAME_ALL & ~bits; }

} // namespace

TEST(hardware, reads_its_section_and_leaves_the_rest_to_others) {
    const hardware_t hardware = hardware_of(can_rover);
    EXPECT_TRUE(hardware_is(&hardware, HARDWARE_wheels, "can"));
    EXPECT_EQ(hardware.key[HARDWARE_emergency_stop_line].number, 4);
    EXPECT_EQ(hardware.key[HARDWARE_emergency_stop_line].line, 11);
    EXPECT_EQ(hardware.key[HARDWARE_watchdog_s].number, 1); // left out
    EXPECT_FALSE(hardware_has(&hardware, HARDWARE_radar_device));
}

TEST(hardware, tells_every_mistake_with_file_line_key_value_and_mend) {
    const struct {
        std::string what, by, said;
    } mistakes[] = {
        {"wheels = \"can\"", "wheels = \"flexray\"", "rover.toml:6: hardware.wheels = \"flexray\": unknown; one of can|pwm"},
        {"wheels = \"can\"", "wheels = \"ca\"", "unknown; one of can|pwm"},
        {"wheels = \"can\"", "wheels = can", "rover.toml:6: hardware.wheels = can: write a text in \"quotes\""},
        {"led_line = 8", "led_line = 8.5", "rover.toml:16: hardware.led_line = 8.5: give a whole number from 0 to 511"},
        {"led_line = 8", "led_line = 512", "give a whole number from 0 to 511"},
        {"led_line = 8", "led_line = 99999999999999999999", "give a whole number"},
        {"led_line = 8", "led_lines = 8", "rover.toml:16: hardware.led_lines = 8: unknown key"},
        {"led_line = 8", "brake_line = 8", "rover.toml:16: hardware.brake_line = 8: given twice"},
        {"led_line = 8", "led_line = 7", "rover.toml:16: hardware.led_line = 7: is brake_line already (line 15)"},
        {"led_line = 8", "led_line", "no '='"},
        {"can_interface = \"can7\"\n", "", "rover.toml:5: hardware.can_interface: missing; \"can\" needs it"},
        {"emergency_stop_line = 4\n", "", "hardware.emergency_stop_line: missing; emergency_stop = \"gpio\" needs it"},
        {"gpio_chip = \"gpiochip0\"\n", "", "hardware.gpio_chip: missing; a line needs it"},
        {"sensors = \"can\"", "sensors = \"iio\"", "hardware.radar_device: missing; sensors = \"iio\" needs it"},
        {"wheels = \"can\"", "wheels = \"pwm\"", "hardware.pwm_0: missing; wheels = \"pwm\" needs it"},
        {"can_interface = \"can7\"", "can_interface = \"../can7\"", "a device's name has no \"..\""},
        {"[hardware]", "[hard_ware]", "rover.toml: no section [hardware]"},
        {"[body]", "[hardware]\n[body]", "rover.toml:6: hardware.section"},
        {"[body]", "[steering]\nfront = 1\n[body]", "hardware.steering = [steering]: these devices have no steering servo"},
        {"watchdog = \"watchdog0\"", "watchdog = \"" + std::string(70, 'w') + "\"", "longer than 63"},
        {"watchdog = \"watchdog0\"", "watchdog = \"" + std::string(400, 'w') + "\"", "rover.toml:17: hardware.line: too long"},
    };
    for (const auto &[what, by, said] : mistakes)
        EXPECT_NE(refused(replaced(can_rover, what, by)).find(said), std::string::npos) << refused(replaced(can_rover, what, by));
    EXPECT_NE(refused("[hardware]\nwheels=\"pwm\"\nsensors=\"iio\"\nemergency_stop=\"can\"\n").find("the line is the sensor node's"),
              std::string::npos);
    hardware_t hardware;
    char message[HARDWARE_MESSAGE];
    EXPECT_FALSE(hardware_read("/nowhere/rover.toml", &hardware, message));
    EXPECT_NE(std::string(message).find("/nowhere/rover.toml: cannot be read"), std::string::npos);
}

TEST(hardware, takes_any_bytes_without_harm) {
    std::uint32_t state = 1;
    const auto next = [&state] { return state = state * 1664525u + 1013904223u, state >> 24; };
    for (int n = 0; n < 2000; n++) {
        std::string text = can_rover;
        for (unsigned i = 0; i < 8; i++) text[(next() << 8 | next()) % text.size()] = static_cast<char>(next());
        hardware_t hardware;
        char message[HARDWARE_MESSAGE] = "";
        if (!hardware_parse(text.data(), text.size(), "rover.toml", &hardware, message)) {
            EXPECT_NE(message[0], '\0');
        }
    }
}

TEST(can_socket, carries_frames_both_ways_and_leaves_out_what_is_none_of_the_rovers) {
    const auto ends = wire();
    can_socket_t bus;
    can_socket_adopt(&bus, ends[0]);
    can_frame_t frame{};
    EXPECT_EQ(can_socket_receive(&bus, &frame), CAN_SOCKET_NOTHING);
    say(ends[1], CAN_WHEEL | CAN_EFF_FLAG, {1});
    say(ends[1], CAN_WHEEL | CAN_RTR_FLAG, {1});
    if (send(ends[1], "x", 1, 0) != 1) FAIL();
    say(ends[1], CAN_WHEEL + 2, {1, 2, 3});
    ASSERT_EQ(can_socket_receive(&bus, &frame), CAN_SOCKET_OK);
    EXPECT_EQ(frame.id, CAN_WHEEL + 2u);
    EXPECT_EQ(frame.length, 3);
    EXPECT_EQ(frame.data[2], 3);
    const can_frame_t order{CAN_ORDER, 5, {9, 8, 7, 6, 5}};
    EXPECT_EQ(can_socket_send(&bus, &order, 0), CAN_SOCKET_OK);
    struct can_frame raw {};
    ASSERT_EQ(recv(ends[1], &raw, sizeof raw, 0), static_cast<ssize_t>(sizeof raw));
    EXPECT_EQ(raw.can_id, static_cast<canid_t>(CAN_ORDER));
    EXPECT_EQ(raw.can_dlc, 5);
    EXPECT_EQ(raw.data[4], 5);
    close(ends[1]);
    EXPECT_EQ(can_socket_receive(&bus, &frame), CAN_SOCKET_GONE);
    EXPECT_EQ(can_socket_send(&bus, &order, 0), CAN_SOCKET_GONE);
    can_socket_close(&bus);
}

TEST(can_socket, sends_nothing_while_bus_off_and_goes_on_once_restarted) {
    const auto ends = wire();
    can_socket_t bus;
    can_socket_adopt(&bus, ends[0]);
    can_frame_t frame{};
    const can_frame_t order{CAN_ORDER, 5, {}};
    say(ends[1], CAN_ERR_FLAG | CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_OVERFLOW, 0, 0, 0, 0, 0, 0});
    say(ends[1], CAN_ERR_FLAG | CAN_ERR_ACK, std::vector<std::uint8_t>(8));
    say(ends[1], CAN_ERR_FLAG | CAN_ERR_BUSOFF, std::vector<std::uint8_t>(8));
    EXPECT_EQ(can_socket_receive(&bus, &frame), CAN_SOCKET_NOTHING); // they are no frames
    EXPECT_TRUE(bus.bus_off && bus.passive);
    EXPECT_EQ(bus.bus_offs, 1u);
    EXPECT_EQ(bus.overflows, 1u);
    EXPECT_EQ(bus.errors, 1u);
    EXPECT_EQ(can_socket_send(&bus, &order, 5), CAN_SOCKET_OFF);
    EXPECT_EQ(bus.restart_due_ns, 100000005); // asked for at once, and again in 100 ms
    EXPECT_EQ(can_socket_send(&bus, &order, 6), CAN_SOCKET_OFF);
    EXPECT_EQ(bus.restart_due_ns, 100000005);
    struct can_frame raw {};
    EXPECT_LT(recv(ends[1], &raw, sizeof raw, MSG_DONTWAIT), 0);
    say(ends[1], CAN_ERR_FLAG | CAN_ERR_RESTARTED, std::vector<std::uint8_t>(8));
    EXPECT_EQ(can_socket_receive(&bus, &frame), CAN_SOCKET_NOTHING);
    EXPECT_EQ(can_socket_send(&bus, &order, 7), CAN_SOCKET_OK);
    can_socket_close(&bus);
    close(ends[1]);
}

TEST(can_socket, asks_for_a_restart_as_rtnetlink_lays_it_out) {
    alignas(8) unsigned char message[128];
    const std::size_t length = can_restart_message(3, message);
    nlmsghdr head;
    std::memcpy(&head, message, sizeof head);
    EXPECT_EQ(head.nlmsg_len, length);
    EXPECT_EQ(head.nlmsg_type, RTM_NEWLINK);
    ifinfomsg link;
    std::memcpy(&link, message + NLMSG_HDRLEN, sizeof link);
    EXPECT_EQ(link.ifi_index, 3);
    // an attribute: its head, then its bytes, the next one aligned; whole within `end`
    const auto attribute = [&message](std::size_t at, std::size_t end) {
        rtattr info{};
        EXPECT_LE(at + RTA_LENGTH(0), end);
        std::memcpy(&info, message + at, sizeof info);
        EXPECT_GE(info.rta_len, RTA_LENGTH(0));
        EXPECT_LE(at + info.rta_len, end);
        return info;
    };
    const std::size_t info_at = NLMSG_SPACE(sizeof(ifinfomsg));
    const rtattr info = attribute(info_at, length);
    ASSERT_EQ(info.rta_type, IFLA_LINKINFO);
    const std::size_t kind_at = info_at + RTA_LENGTH(0), end = info_at + info.rta_len;
    const rtattr kind = attribute(kind_at, end);
    ASSERT_EQ(kind.rta_type, IFLA_INFO_KIND);
    EXPECT_EQ(std::string(message + kind_at + RTA_LENGTH(0), message + kind_at + kind.rta_len), "can");
    const std::size_t data_at = kind_at + RTA_ALIGN(kind.rta_len);
    const rtattr data = attribute(data_at, end);
    ASSERT_EQ(data.rta_type, IFLA_INFO_DATA);
    const std::size_t restart_at = data_at + RTA_LENGTH(0);
    const rtattr restart = attribute(restart_at, data_at + data.rta_len);
    EXPECT_EQ(restart.rta_type, IFLA_CAN_RESTART);
    ASSERT_EQ(restart.rta_len, RTA_LENGTH(sizeof(std::uint32_t)));
    std::uint32_t value = 0;
    std::memcpy(&value, message + restart_at + RTA_LENGTH(0), sizeof value);
    EXPECT_EQ(value, 1u);
}

TEST(gpio, speaks_both_versions_of_the_kernels_interface_and_says_who_has_a_line) {
    for (const int version : {2, 1}) {
        lines() = {};
        lines().version = version;
        gpio_chip_t chip{.ioctl = line_call, .chip = -1};
        ASSERT_EQ(gpio_open(&chip, "/dev/null"), 0);
        gpio_line_t in{}, out{}, none{};
        ASSERT_EQ(gpio_take(&chip, 4, false, true, &in), 0);
        ASSERT_EQ(gpio_take(&chip, 6, true, false, &out), 0);
        lines().level[4] = 0;
        EXPECT_EQ(gpio_get(&chip, &in), 1) << version; // active low
        lines().level[4] = 1;
        EXPECT_EQ(gpio_get(&chip, &in), 0);
        EXPECT_EQ(gpio_set(&chip, &out, true), 0);
        EXPECT_EQ(lines().level[6], 1);
        lines().taken[9] = true;
        EXPECT_EQ(gpio_take(&chip, 9, true, false, &none), -EBUSY);
        EXPECT_EQ(none.fd, -1);
        EXPECT_EQ(gpio_take(&chip, 40, true, false, &none), -EINVAL); // the chip has 32
        gpio_release(&in);
        gpio_release(&out);
        gpio_close(&chip);
    }
    gpio_chip_t chip{.ioctl = nullptr, .chip = -1};
    EXPECT_EQ(gpio_open(&chip, "/dev/nowhere"), -ENOENT);
}

namespace {

void converter(const Folder &folder, const std::string &type = "le:u10/16>>0") {
    const std::string device = "sys/bus/iio/devices/iio:device0/";
    folder.put(device + "buffer/enable", "0");
    folder.put(device + "buffer/length", "2");
    folder.put(device + "buffer/watermark", "1");
    folder.put(device + "trigger/current_trigger", "\n");
    folder.put(device + "scan_elements/in_voltage0_en", "0");
    folder.put(device + "scan_elements/in_voltage0_type", type + "\n");
    folder.put(device + "scan_elements/in_voltage1_en", "1");
    folder.put(device + "scan_elements/in_timestamp_en", "0");
    folder.put(device + "sampling_frequency", "500\n");
    folder.fifo("dev/iio:device0");
}

struct Scan {
    std::uint8_t sample[8] = {};
    std::int64_t stamp_ns = 0;
};

Scan scan(std::uint32_t little, std::int64_t stamp_ns) {
    Scan out;
    std::memcpy(out.sample, &little, 4);
    out.stamp_ns = stamp_ns;
    return out;
}

} // namespace

TEST(iio, sets_the_capture_up_and_numbers_samples_over_what_was_lost) {
    const Folder folder;
    converter(folder);
    iio_capture_t capture;
    const iio_config_t config{folder.path().c_str(), "iio:device0", "in_voltage0", "radar-trigger", 512};
    iio_part_t part{};
    char why[IIO_MESSAGE];
    ASSERT_TRUE(iio_capture_open(&capture, &config, &part, why)) << why;
    const std::string device = "sys/bus/iio/devices/iio:device0/";
    EXPECT_EQ(folder.get(device + "trigger/current_trigger"), "radar-trigger");
    EXPECT_EQ(folder.get(device + "scan_elements/in_voltage0_en"), "1");
    EXPECT_EQ(folder.get(device + "scan_elements/in_voltage1_en"), "0");
    EXPECT_EQ(folder.get(device + "scan_elements/in_timestamp_en"), "1");
    EXPECT_EQ(folder.get(device + "sampling_frequency"), "512");
    EXPECT_EQ(folder.get(device + "buffer/enable"), "1");
    const int device_fd = open((folder.path() + "/dev/iio:device0").c_str(), O_WRONLY);
    std::uint16_t sample[8];
    std::uint32_t first = 0;
    EXPECT_EQ(iio_capture_read(&capture, sample, 8, &first), 0);
    const std::int64_t period = 1000000000 / 512;
    std::int64_t at = 5000;
    const auto feed = [&](std::uint32_t value, int periods) {
        at += periods * period;
        const Scan one = scan(value, at);
        ASSERT_EQ(write(device_fd, &one, sizeof one), static_cast<ssize_t>(sizeof one));
    };
    for (std::uint32_t i = 0; i < 5; i++) feed(1000 + i, 1);
    ASSERT_EQ(iio_capture_read(&capture, sample, 8, &first), 5);
    EXPECT_EQ(first, 0u);
    EXPECT_EQ(sample[4], 1004);
    feed(7, 1);
    feed(8, 4); // three are missing: what follows is another run
    feed(9, 1);
    ASSERT_EQ(iio_capture_read(&capture, sample, 8, &first), 2);
    EXPECT_EQ(first, 9u);
    EXPECT_EQ(sample[0], 8);
    EXPECT_EQ(capture.lost, 3u);
    for (std::uint32_t i = 0; i < 11; i++) feed(i, 1); // more than there is room for: the newest stay
    ASSERT_EQ(iio_capture_read(&capture, sample, 8, &first), 8);
    EXPECT_EQ(first, 14u);
    EXPECT_EQ(sample[7], 10);
    const Scan half = scan(77, at + period); // a sample in two pieces
    ASSERT_EQ(write(device_fd, &half, 5), 5);
    EXPECT_EQ(iio_capture_read(&capture, sample, 8, &first), 0);
    ASSERT_EQ(write(device_fd, reinterpret_cast<const char *>(&half) + 5, sizeof half - 5), static_cast<ssize_t>(sizeof half - 5));
    ASSERT_EQ(iio_capture_read(&capture, sample, 8, &first), 1);
    EXPECT_EQ(sample[0], 77);
    iio_capture_close(&capture);
    EXPECT_EQ(folder.get(device + "buffer/enable"), "0");
    close(device_fd);
}

TEST(iio, reads_every_layout_of_a_sample_as_ten_bits) {
    const struct {
        const char *type;
        std::uint32_t stored;
        int sample; // -1: refused
    } layouts[] = {{"le:u10/16>>0", 0x03ff, 1023},
                   {"le:u12/16>>4", 0xfff0, 1023},
                   {"be:u12/16>>0", 0xff0f, 1023}, // bytes 0f ff
                   {"le:s12/16>>0", 0x0000, 512},
                   {"le:s12/16>>0", 0x0800, 0},
                   {"le:u8/8>>0", 0xc8, 200},
                   {"le:u24/32>>8", 0x80000000, 512},
                   {"le:u32/32>>0", 0xffffffff, 1023},
                   {"le:u12/16>>5", 0, -1},
                   {"le:u64/64>>0", 0, -1},
                   {"me:u12/16>>0", 0, -1},
                   {"nonsense", 0, -1}};
    for (const auto &[type, stored, expected] : layouts) {
        const Folder folder;
        converter(folder, type);
        iio_capture_t capture;
        const iio_config_t config{folder.path().c_str(), "iio:device0", "in_voltage0", "", 512};
        iio_part_t part{};
        char why[IIO_MESSAGE];
        ASSERT_EQ(iio_capture_open(&capture, &config, &part, why), expected >= 0) << type;
        if (expected < 0) {
            EXPECT_EQ(part, IIO_CHANNEL);
            continue;
        }
        const int device_fd = open((folder.path() + "/dev/iio:device0").c_str(), O_WRONLY);
        const Scan one = scan(stored, 1);
        ASSERT_EQ(write(device_fd, &one, sizeof one), static_cast<ssize_t>(sizeof one));
        std::uint16_t sample = 0;
        std::uint32_t first = 0;
        ASSERT_EQ(iio_capture_read(&capture, &sample, 1, &first), 1);
        EXPECT_EQ(sample, expected) << type;
        iio_capture_close(&capture);
        close(device_fd);
    }
}

TEST(iio, tells_what_part_of_a_capture_does_not_do) {
    const auto part_of = [](const Folder &folder, const iio_config_t &config) {
        iio_capture_t capture;
        iio_part_t part{};
        char why[IIO_MESSAGE] = "";
        EXPECT_FALSE(iio_capture_open(&capture, &config, &part, why));
        EXPECT_NE(why[0], '\0');
        (void)folder;
        return part;
    };
    const Folder folder;
    converter(folder);
    const char *root = folder.path().c_str();
    EXPECT_EQ(part_of(folder, {root, "iio:device9", "in_voltage0", "", 512}), IIO_DEVICE);
    EXPECT_EQ(part_of(folder, {root, "iio:device0", "in_voltage9", "", 512}), IIO_CHANNEL);
    std::filesystem::remove(folder.path() + "/sys/bus/iio/devices/iio:device0/trigger/current_trigger");
    std::filesystem::remove(folder.path() + "/sys/bus/iio/devices/iio:device0/trigger");
    EXPECT_EQ(part_of(folder, {root, "iio:device0", "in_voltage0", "t", 512}), IIO_TRIGGER);
    std::filesystem::permissions(folder.path() + "/sys/bus/iio/devices/iio:device0/sampling_frequency", std::filesystem::perms::owner_read);
    if (geteuid() != 0) { // root writes all the same
        EXPECT_EQ(part_of(folder, {root, "iio:device0", "in_voltage0", "", 512}), IIO_RATE);
    }
    std::filesystem::remove(folder.path() + "/sys/bus/iio/devices/iio:device0/scan_elements/in_timestamp_en");
    EXPECT_EQ(part_of(folder, {root, "iio:device0", "in_voltage0", "", 512}), IIO_CHANNEL); // without its time nothing lost is seen
}

namespace {

const std::string board_rover =
    "[hardware]\nwheels = \"pwm\"\nsensors = \"iio\"\nemergency_stop = \"gpio\"\ngpio_chip = \"gpiochip0\"\n"
    "emergency_stop_line = 4\nmotor_enable_line = 6\nbrake_line = 7\n"
    "radar_device = \"iio:device0\"\nradar_channel = \"in_voltage0\"\nbattery = \"iio:device1/in_voltage4_raw\"\n"
    "accel_x = \"iio:device2/in_accel_x_raw\"\ngyro_z = \"iio:device2/in_anglvel_z_raw\"\n"
    "pwm_0 = \"pwmchip0/0\"\npwm_1 = \"pwmchip0/1\"\npwm_2 = \"pwmchip0/2\"\npwm_3 = \"pwmchip0/3\"\n"
    "direction_line_0 = 10\ndirection_line_1 = 11\ndirection_line_2 = 12\ndirection_line_3 = 13\n"
    "counter_0 = \"counter0/count0\"\ncounter_1 = \"counter0/count1\"\ncounter_2 = \"counter1/count0\"\n"
    "counter_3 = \"counter1/count1\"\ncurrent_0 = \"iio:device1/in_voltage0_raw\"\n"
    "current_1 = \"iio:device1/in_voltage1_raw\"\ncurrent_2 = \"iio:device1/in_voltage2_raw\"\n"
    "current_3 = \"iio:device1/in_voltage3_raw\"\n";

struct Board {
    Folder folder;
    linux_hal_t devices{};
    hal_t hal{};
    explicit Board(const std::string &text = board_rover) {
        lines() = {};
        converter(folder);
        folder.put("dev/gpiochip0", "");
        for (int i = 0; i < 4; i++) {
            const std::string pwm = "sys/class/pwm/pwmchip0/pwm" + std::to_string(i);
            folder.put(pwm + "/enable", "1");
            folder.put(pwm + "/duty_cycle", "17");
            folder.put(pwm + "/period", "0");
            folder.put("sys/bus/counter/devices/counter" + std::to_string(i / 2) + "/count" + std::to_string(i % 2) + "/count",
                       std::to_string(4294967290LL + i) + "\n");
            folder.put("sys/bus/iio/devices/iio:device1/in_voltage" + std::to_string(i) + "_raw", std::to_string(2048 + i) + "\n");
        }
        folder.put("sys/bus/iio/devices/iio:device1/in_voltage4_raw", "1800\n");
        folder.put("sys/bus/iio/devices/iio:device2/in_accel_x_raw", "-7\n");
        folder.put("sys/bus/iio/devices/iio:device2/in_anglvel_z_raw", "9\n");
        const hardware_t hardware = hardware_of(text);
        linux_hal_begin(&devices, &hardware, folder.path().c_str());
        devices.chip.ioctl = line_call;
        hal = linux_hal(&devices);
    }
    std::string pwm(int wheel, const char *name) const {
        return folder.get("sys/class/pwm/pwmchip0/pwm" + std::to_string(wheel) + "/" + name);
    }
};

} // namespace

TEST(linux_hal, drives_a_board_without_nodes_by_its_own_pwm_and_counters) {
    Board board;
    ASSERT_EQ(hal_open_devices(&board.hal), HAL_OK) << board.devices.trouble;
    EXPECT_EQ(board.pwm(0, "enable"), "0");
    EXPECT_EQ(board.pwm(0, "period"), "50000");
    const int device_fd = open((board.folder.path() + "/dev/iio:device0").c_str(), O_WRONLY);
    const Scan one = scan(512, 1);
    ASSERT_EQ(write(device_fd, &one, sizeof one), static_cast<ssize_t>(sizeof one));
    EXPECT_EQ(board.hal.wait_tick(board.hal.context), HAL_OK);
    sensor_frame_t frame{};
    EXPECT_EQ(board.hal.read(board.hal.context, &frame), HAL_OK);
    EXPECT_EQ(frame.present, all_but_bits(FRAME_ACCEL_YZ | FRAME_GYRO_XY));
    EXPECT_EQ(frame.encoder_count[0], -6); // the counter's 2^32 - 6: wraps as 32 bits do
    EXPECT_EQ(frame.current_count[3], 2051);
    EXPECT_EQ(frame.battery_count, 1800);
    EXPECT_EQ(frame.accel_x_count, -7);
    EXPECT_EQ(frame.gyro_z_count, 9);
    EXPECT_EQ(frame.radar_count[0], 512);
    EXPECT_FALSE(frame.emergency_stop);
    actuator_frame_t order{};
    order.drive = DRIVE_ON;
    order.duty_q15[0] = 32767;
    order.duty_q15[1] = -16384;
    order.duty_q15[2] = INT16_MIN;
    ASSERT_EQ(board.hal.write(board.hal.context, &order), HAL_OK);
    EXPECT_EQ(board.pwm(0, "duty_cycle"), "50000");
    EXPECT_EQ(board.pwm(1, "duty_cycle"), "25000"); // 16384/32767 of 50,000, rounded down
    EXPECT_EQ(board.pwm(2, "duty_cycle"), "50000");
    EXPECT_EQ(board.pwm(0, "enable"), "1");
    EXPECT_EQ(lines().level[10], 0);
    EXPECT_EQ(lines().level[11], 1);
    EXPECT_EQ(lines().level[6], 1); // motor enable
    order.drive = DRIVE_BRAKE;
    ASSERT_EQ(board.hal.write(board.hal.context, &order), HAL_OK);
    EXPECT_EQ(board.pwm(0, "duty_cycle"), "0");
    EXPECT_EQ(board.pwm(0, "enable"), "1");
    EXPECT_EQ(lines().level[7], 1);
    order.drive = DRIVE_COAST;
    ASSERT_EQ(board.hal.write(board.hal.context, &order), HAL_OK);
    EXPECT_EQ(board.pwm(0, "enable"), "0");
    EXPECT_EQ(lines().level[7], 0);
    board.hal.safe_stop(board.hal.context);
    EXPECT_EQ(lines().level[6], 0);
    hal_close_devices(&board.hal);
    close(device_fd);
}

TEST(linux_hal, refuses_a_device_that_is_not_there_with_file_line_and_key) {
    const struct {
        std::string what, by, said;
    } wrong[] = {
        {"pwmchip0/2", "pwmchip1/2", "rover.toml:16: hardware.pwm_2 = \"pwmchip1/2\": no such PWM"},
        {"pwmchip0/2", "pwmchip0", "hardware.pwm_2 = \"pwmchip0\": no such PWM"},
        {"counter1/count0", "counter7/count0", "rover.toml:24: hardware.counter_2 = \"counter7/count0\": no such counter"},
        {"in_voltage3_raw", "in_voltage8_raw", "hardware.current_3 = \"iio:device1/in_voltage8_raw\": no such channel"},
        {"in_voltage4_raw", "in_voltage9_raw", "hardware.battery"},
        {"radar_device = \"iio:device0\"", "radar_device = \"iio:device5\"",
         "rover.toml:9: hardware.radar_device = \"iio:device5\": no buffered capture"},
        {"radar_channel = \"in_voltage0\"", "radar_channel = \"in_voltage7\"", "rover.toml:10: hardware.radar_channel = \"in_voltage7\""},
        {"gpiochip0", "gpiochip9", "rover.toml:5: hardware.gpio_chip = \"gpiochip9\": is no GPIO chip"},
        {"emergency_stop_line = 4", "emergency_stop_line = 44",
         "rover.toml:6: hardware.emergency_stop_line = 44: the line cannot be taken"},
        {"brake_line = 7\n", "brake_line = 7\nwatchdog = \"watchdog3\"\n", "hardware.watchdog = \"watchdog3\": cannot be started"},
    };
    for (const auto &[what, by, said] : wrong) {
        Board board(replaced(board_rover, what, by));
        EXPECT_EQ(hal_open_devices(&board.hal), HAL_ERR_CONFIG) << by;
        EXPECT_NE(std::string(board.devices.trouble).find(said), std::string::npos) << board.devices.trouble;
        board.hal.safe_stop(board.hal.context); // does nothing, and no harm
    }
    Board taken;
    lines().taken[12] = true;
    EXPECT_EQ(hal_open_devices(&taken.hal), HAL_ERR_CONFIG);
    EXPECT_NE(std::string(taken.devices.trouble)
                  .find("hardware.direction_line_2 = 12: cannot be taken; gpioinfo tells who has it: Device or resource busy"),
              std::string::npos)
        << taken.devices.trouble;
    Rover rover;
    can_socket_close(&rover.devices.bus);
    EXPECT_EQ(hal_open_devices(&rover.hal), HAL_ERR_CONFIG); // there is no can7 here
    EXPECT_NE(std::string(rover.devices.trouble).find("rover.toml:9: hardware.can_interface = \"can7\": is no CAN interface"),
              std::string::npos)
        << rover.devices.trouble;
}

TEST(linux_hal, a_tick_on_the_bus_brings_every_device_and_takes_every_order) {
    Rover rover;
    ASSERT_EQ(hal_open_devices(&rover.hal), HAL_OK) << rover.devices.trouble;
    hal_status_t status;
    ASSERT_EQ(hal_self_test(&rover.hal, &status), HAL_OK);
    for (const std::uint8_t device : status.device) EXPECT_EQ(device, HAL_DEVICE_WORKS);
    std::uint32_t answered = FRAME_ALL, radar = 0, complete = 0;
    for (std::uint32_t i = 0; i < 20; i++) {
        sensor_frame_t frame{};
        ASSERT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_OK);
        (void)rover.hal.read(rover.hal.context, &frame); // a loaded machine may keep the nodes' thread waiting for more than 3 ms
        answered &= frame.present;
        if (frame.present == FRAME_ALL) {
            EXPECT_EQ(frame.encoder_count[2], 200);
            EXPECT_EQ(frame.battery_count, 1800);
            EXPECT_FALSE(frame.emergency_stop);
            EXPECT_GT(frame.radar_sequence, radar);
            radar = frame.radar_sequence;
            complete++;
        }
        actuator_frame_t order{};
        order.sequence = i + 1;
        order.drive = DRIVE_ON;
        for (std::int16_t &duty : order.duty_q15) duty = static_cast<std::int16_t>(1000 + i);
        ASSERT_EQ(rover.hal.write(rover.hal.context, &order), HAL_OK);
        hal_kick_watchdog(&rover.hal);
    }
    EXPECT_NE(answered & FRAME_EMERGENCY_STOP, 0u);
    EXPECT_GT(complete, 0u);
    EXPECT_EQ(lines().level[6], 1);
    EXPECT_TRUE(soon([&] { return rover.nodes.orders == 80; })) << rover.nodes.orders;
    EXPECT_EQ(rover.nodes.last_duty_0, 1019);
    rover.hal.safe_stop(rover.hal.context);
    EXPECT_TRUE(soon([&] { return rover.nodes.orders == 88 && rover.nodes.all_off; })); // twice to each
    EXPECT_EQ(lines().level[6], 0);
    hal_close_devices(&rover.hal);
    EXPECT_EQ(whole(rover.folder.path() + "/dev/watchdog0"), std::string(20, '\0') + "V"); // kicked 20 times, then stopped
}

TEST(linux_hal, a_pressed_or_missing_stop_is_told_in_the_same_tick) {
    Rover rover;
    ASSERT_EQ(hal_open_devices(&rover.hal), HAL_OK);
    lines().level[4] = 0; // active low
    ASSERT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_OK);
    sensor_frame_t frame{};
    (void)rover.hal.read(rover.hal.context, &frame);
    EXPECT_TRUE(frame.emergency_stop);
    EXPECT_NE(frame.present & FRAME_EMERGENCY_STOP, 0u);
    lines().level[5] = 0; // its cable is out: nobody knows
    ASSERT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_OK);
    EXPECT_EQ(rover.hal.read(rover.hal.context, &frame), HAL_ERR_TIMEOUT);
    EXPECT_EQ(frame.present & FRAME_EMERGENCY_STOP, 0u);
    hal_close_devices(&rover.hal);
}

TEST(linux_hal, a_silent_node_costs_its_bits_and_three_milliseconds_and_no_tick) {
    Rover rover;
    ASSERT_EQ(hal_open_devices(&rover.hal), HAL_OK);
    (void)rover.hal.wait_tick(rover.hal.context);
    rover.nodes.silent = 1u << 1 | 16u;
    const std::uint32_t lost = (FRAME_ENCODER_0 | FRAME_CURRENT_0 | FRAME_BRIDGE_0) << 1;
    // on a loaded machine the nodes' thread may still owe the answer to a request from before
    EXPECT_TRUE(soon([&] {
        sensor_frame_t frame{};
        return rover.hal.wait_tick(rover.hal.context) == HAL_OK && rover.hal.read(rover.hal.context, &frame) == HAL_ERR_TIMEOUT &&
               (frame.present & (lost | FRAME_BATTERY | FRAME_RADAR)) == 0;
    }));
    timespec begin{}, end{};
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int i = 0; i < 10; i++) {
        const sensor_frame_t frame = rover.tick(HAL_ERR_TIMEOUT);
        EXPECT_EQ(frame.present & (lost | FRAME_BATTERY | FRAME_RADAR), 0u);
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    const double took_s = static_cast<double>(end.tv_sec - begin.tv_sec) + 1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
    EXPECT_GT(took_s, 0.085); // ten ticks, the last without its sleep
    hal_status_t status;
    ASSERT_EQ(hal_status(&rover.hal, &status), HAL_OK);
    EXPECT_EQ(status.device[1], HAL_DEVICE_SILENT);
    hal_close_devices(&rover.hal);
}

TEST(linux_hal, missed_ticks_are_counted_and_the_grid_stays) {
    Rover rover;
    ASSERT_EQ(hal_open_devices(&rover.hal), HAL_OK);
    ASSERT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_OK);
    sensor_frame_t frame{};
    (void)rover.hal.read(rover.hal.context, &frame);
    EXPECT_EQ(frame.tick, 0u);
    const std::int64_t due_ns = rover.devices.due_ns;
    usleep(45000); // four deadlines pass, the fifth is ahead on an idle machine
    ASSERT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_OK);
    (void)rover.hal.read(rover.hal.context, &frame);
    EXPECT_GE(frame.elapsed_ticks, 4u);
    EXPECT_EQ(frame.tick, frame.elapsed_ticks);
    EXPECT_EQ(rover.devices.overruns, 1u);
    EXPECT_EQ((rover.devices.due_ns - due_ns) % 10000000, 0);
    hal_close_devices(&rover.hal);
}

TEST(linux_hal, bus_off_costs_orders_and_a_bus_that_is_gone_ends_the_run) {
    Rover rover;
    ASSERT_EQ(hal_open_devices(&rover.hal), HAL_OK);
    (void)rover.hal.wait_tick(rover.hal.context);
    actuator_frame_t order{};
    order.drive = DRIVE_ON;
    rover.devices.bus.bus_off = true;
    EXPECT_EQ(rover.hal.write(rover.hal.context, &order), HAL_ERR_TIMEOUT);
    EXPECT_EQ(rover.devices.lost_writes, 1u);
    rover.devices.bus.bus_off = false;
    shutdown(rover.devices.bus.fd, SHUT_RDWR);
    EXPECT_EQ(rover.hal.write(rover.hal.context, &order), HAL_ERR_IO);
    EXPECT_EQ(rover.hal.wait_tick(rover.hal.context), HAL_ERR_IO);
    EXPECT_NE(std::string(rover.devices.trouble).find("hardware.can_interface = \"can7\": the interface is down or away"),
              std::string::npos);
    hal_close_devices(&rover.hal);
}

TEST(watchdog, is_kicked_and_stopped_by_its_magic_letter) {
    const Folder folder;
    folder.put("watchdog", "");
    const std::string path = folder.path() + "/watchdog";
    int fd = watchdog_open(path.c_str(), 1);
    ASSERT_GE(fd, 0);
    watchdog_kick(fd);
    watchdog_kick(fd);
    watchdog_close(&fd);
    EXPECT_EQ(fd, -1);
    EXPECT_EQ(whole(path), std::string("\0\0V", 3));
    EXPECT_EQ(watchdog_open((folder.path() + "/none").c_str(), 1), -ENOENT);
}
