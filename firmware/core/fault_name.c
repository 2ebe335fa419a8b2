#include "fault_name.h"

const char *fault_name(int32_t bit)
{
    static const char name[][32] = {"emergency stop",     "command timeout",
                                    "encoder lost",       "current lost",
                                    "accelerometer lost", "radar lost",
                                    "battery lost",       "low battery",
                                    "over-current",       "stall",
                                    "missed ticks",       "speeds disagree",
                                    "over-temperature",   "gyro lost",
                                    "absurd sensor",      "bridge",
                                    "motor open",         "encoder against its motor",
                                    "brown-out",          "speed beyond the radar's band"};
    _Static_assert(sizeof name / sizeof *name == FAULT_COUNT, "one name a bit");
    return bit >= 0 && bit < FAULT_COUNT ? name[bit] : "unknown fault";
}
