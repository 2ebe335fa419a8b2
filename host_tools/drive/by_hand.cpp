// A terminal tells keys that are pressed, and repeats one that is held; it does not tell when one is let go. So the dead-man's key counts
// as held for a moment after each press: long enough for the keyboard's first repeat, then as short as its repeats allow.
#include "drive.h"

#include "firmware/core/signals.h"

#include <functional>
#include <poll.h>
#include <sys/types.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace traction::drive {

namespace {

constexpr double hand_period_s = 0.02, paint_s = 0.1;
constexpr double first_held_s = 0.7; // X11 repeats a key after 0.66 s, others sooner
constexpr double held_s = 0.25;      // assumed: repeats come 10 times a second or faster
constexpr double speed_step_m_s = 0.05, yaw_step_rad_s = 0.1, slip_step = 0.05;

class RawTerminal {
  public:
    RawTerminal() {
        tcgetattr(STDIN_FILENO, &before_);
        termios raw = before_;
        raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        raw.c_cc[VMIN] = 0;
        raw.c_cc[VTIME] = 0;
        tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    }
    ~RawTerminal() { tcsetattr(STDIN_FILENO, TCSANOW, &before_); }
    RawTerminal(const RawTerminal &) = delete;
    RawTerminal &operator=(const RawTerminal &) = delete;

    std::string keys() { // that were pressed since
        std::array<char, 64> bytes{};
        const ssize_t got = read(STDIN_FILENO, bytes.data(), bytes.size());
        return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
    }

  private:
    termios before_{};
};

struct Hand {
    Order order{.mode = MODE_PLATFORM_SPEED};
    double held_until_s = -1, pressed_s = -10;
    bool quit = false, driving = false;
};

// "\x1b[A" is the arrow up; letters stand for it where a terminal sends none.
void take(Hand &hand, std::string keys, double now_s) {
    const auto swallow = [&keys](const char *sequence, char letter) {
        for (std::size_t at = 0; (at = keys.find(sequence)) != std::string::npos;) keys.replace(at, 3, 1, letter);
    };
    swallow("\x1b[A", 'w');
    swallow("\x1b[B", 's');
    swallow("\x1b[D", 'a');
    swallow("\x1b[C", 'd');
    for (const char key : keys) {
        Order &order = hand.order;
        if (key == ' ') {
            const bool repeats = now_s - hand.pressed_s < held_s;
            hand.pressed_s = now_s;
            hand.held_until_s = now_s + (repeats ? held_s : first_held_s);
        } else if (key == 'w' || key == 's') {
            order.speed_m_s += key == 'w' ? speed_step_m_s : -speed_step_m_s;
        } else if (key == 'a' || key == 'd') {
            order.yaw_rate_rad_s += key == 'a' ? yaw_step_rad_s : -yaw_step_rad_s;
        } else if (key == '+' || key == '-') {
            order.slip = std::clamp(order.slip + (key == '+' ? slip_step : -slip_step), -1.0, 1.0);
        } else if (key == 'm') {
            const bool slip = order.mode == MODE_SLIP;
            order.mode = slip ? MODE_PLATFORM_SPEED : MODE_SLIP;
            order.slip_wheels = slip ? 0u : (1u << WHEEL_COUNT) - 1u;
        } else if (key == '0') {
            order.speed_m_s = order.yaw_rate_rad_s = order.slip = 0;
        } else if (key == 'q' || key == '\x04') {
            hand.quit = true;
        } else { // any other key is the hand that slipped
            hand.held_until_s = -1;
        }
    }
}

void paint(const Operator &link, const Hand &hand, bool may_command) {
    const LinkCounts &c = link.counts();
    std::printf("\x1b[H\x1b[J%s  %s\n\n%s\n\n", link.address().c_str(), link.silence_s() > 1 ? "SILENT" : "", line_of(link).c_str());
    std::printf("asked for: %s, %.2f m/s, %.2f rad/s, slip %.2f   %s\n", mode_words(hand.order.mode), hand.order.speed_m_s,
                hand.order.yaw_rate_rad_s, hand.order.slip, hand.driving ? "DRIVES" : "stands");
    std::printf("commands: %u obeyed; refused %u unsigned, %u signature, %u replayed, %u stale, %u other; link lost %u times\n\n",
                c.accepted, c.refused_unsigned, c.refused_signature, c.refused_replay, c.refused_stale, c.refused_other, c.losses);
    if (may_command)
        std::printf("hold SPACE to drive | up/down speed | left/right yaw | m speed or slip | +/- slip | 0 zero | q leave\n");
    else
        std::printf("no --key: watching only | q leave\n");
    std::fflush(stdout);
}

} // namespace

void by_hand(Operator &link, bool may_command, const std::function<bool()> &stopped) {
    RawTerminal terminal;
    Hand hand;
    double painted_s = -1;
    while (!hand.quit && !stopped()) {
        link.listen(hand_period_s);
        const double now_s = link.now_s();
        take(hand, terminal.keys(), now_s);
        const bool was = hand.driving;
        hand.driving = may_command && now_s < hand.held_until_s && link.silence_s() < 1;
        // a stop first, for two ticks: it clears what is latched, as a command that timed out before
        if (hand.driving) link.send(was ? hand.order : Order{.mode = MODE_STOP});
        if (was && !hand.driving) stop(link);
        if (now_s - painted_s >= paint_s) {
            paint(link, hand, may_command);
            painted_s = now_s;
        }
    }
    if (may_command) stop(link);
    std::printf("\n");
}

} // namespace traction::drive
