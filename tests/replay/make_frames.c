// make_frames - writes a deterministic drive through every mode for the HAL `replay`: integer arithmetic only, so its bytes are the same
// on every machine. usage: make_frames OUT.txt
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { FRAME_BITS = 0xfffff }; // every device of the rover

static uint64_t state = 20260101;

static uint32_t draw(uint32_t range) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % range;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// A triangle wave of a phase in 2^16ths of a turn: -256..256.
static int triangle(uint32_t phase) {
    const int p = (int)(phase & 0xffffu);
    return p < 32768 ? p / 64 - 256 : 768 - p / 64;
}

int main(int argc, char **argv) {
    FILE *out = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (out == NULL) {
        fprintf(stderr, "usage: make_frames OUT.txt\n");
        return 2;
    }
    int32_t encoder[4] = {0, 0x7fffff00, -5, 1000};
    uint32_t phase = 0, sequence = 1;
    for (uint32_t tick = 0; tick < 3000; tick++) {
        // a stop of 60 ms in every 200: these wheels obey no motor, and longer than that would be called a contradiction
        const uint32_t mode = tick < 100 || tick % 20 < 6 ? 0 : 1 + (tick / 145) % 5;
        const uint32_t drive = (tick / 300) % 3; // pulses a tick: 0, 25, 50 -> 0, 0.15, 0.30 m/s
        for (int i = 0; i < 4; i++) {
            encoder[i] = (int32_t)((uint32_t)encoder[i] + drive * 25 + draw(5) * (drive > 0));
        }
        const uint32_t lost = tick % 700 == 650 ? 1u << draw(12) : 0u;
        fprintf(out, "%" PRIu32 " 1 %" PRIu32 " %x %d %d %d %d", tick, 10000 * (tick + 1), (unsigned)FRAME_BITS & ~lost, encoder[0],
                encoder[1], encoder[2], encoder[3]);
        for (int i = 0; i < 4; i++) {
            fprintf(out, " %d", 2048 + (int)drive * 120 + (int)draw(40) - 20);
        }
        const uint32_t samples = tick % 25 < 3 ? 6 : 5;
        const int battery = 1800 - (int)draw(20);
        const int accel = (int)draw(100) - 40;
        const int gyro = (int)draw(40) - 20;
        const int roll = (int)draw(40) - 20;
        const int pitch = (int)draw(40) - 20 - (tick >= 1200 && tick < 1250 ? 700 : 0); // a slope of 10 deg begins
        fprintf(out, " %d %d 300 2452 %d %d %d %d 0 0 0 0 %" PRIu32 " %u", battery, accel, roll, pitch, gyro, tick >= 2900 && tick < 2910,
                sequence, samples);
        sequence += samples;
        for (uint32_t n = 0; n < samples; n++) {
            phase += drive * 1150; // about 9 Hz of Doppler per 0.15 m/s
            const int fade = triangle((uint32_t)(tick * 521));
            fprintf(out, " %d", 512 + (drive > 0 ? triangle(phase) * (300 + fade) / 1100 : 0) + (int)draw(9) - 4);
        }
        fprintf(out, " %u %08x %08x", mode, bits_of(0.0625f * (float)(1 + tick / 500)), bits_of(tick > 2000 ? 0.25f : 0.0f));
        for (int i = 0; i < 4; i++) {
            fprintf(out, " %08x", bits_of(1.5f * (float)(i + 1)));
        }
        for (int i = 0; i < 4; i++) {
            fprintf(out, " %08x", bits_of(0.125f * (float)(i - 1)));
        }
        fprintf(out, " %08x %d 0\n", bits_of(0.375f), 2);
    }
    return fclose(out) != 0 ? 4 : 0;
}
