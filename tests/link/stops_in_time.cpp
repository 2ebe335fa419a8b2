// stops_in_time LOG.ulg: in a rover's own log, no tick drives whose command is older than 80 ms by the rover's clock, and at least one
// command came to be older: an operator fell silent while the rover drove. So it stopped in the tick in which the command's age passed
// that, at most 10 ms later.
#include "host_tools/board/board_log.h"

#include <cstdint>
#include <cstdio>
#include <exception>

int main(int argc, char **argv) {
    if (argc != 2) return 2;
    try {
        std::size_t losses = 0, wrong = 0;
        std::uint32_t oldest = 0;
        bool was = false;
        for (const traction::board::BoardTick &tick : traction::board::read_board_log(argv[1]).ticks) {
            const bool drives = tick.trace.actuator.drive == DRIVE_ON, old = tick.command.age_ticks > 8;
            if (drives && tick.command.age_ticks > oldest) oldest = tick.command.age_ticks;
            wrong += drives && old ? 1 : 0;
            losses += old && !was && (tick.trace.faults & FAULT_COMMAND_TIMEOUT) != 0 ? 1 : 0;
            was = old;
        }
        std::printf("%s: %zu losses of the operator; driven on commands of at most %u ms; %zu ticks drive on older ones\n", argv[1], losses,
                    10 * oldest, wrong);
        return losses > 0 && wrong == 0 ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "stops_in_time: %s\n", error.what());
        return 2;
    }
}
