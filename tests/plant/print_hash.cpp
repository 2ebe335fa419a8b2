// print_hash - runs the plant on three grounds and with each contact law and prints the hash of its state, one line each.
#include "sim/plant/plant.h"

#include <cinttypes>
#include <cstdio>

using namespace traction::sim;

int main() {
    for (const char *name : {"concrete", "gravel", "sand"})
        for (const ContactLaw law : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            PlantConfig config;
            config.ground.soil = *find_soil(name);
            config.ground.contact = law;
            config.ground.grip_noise = 0.06;
            config.rover.centre_height_m = 0.06;
            const Effect *ripple = find_effect("torque_ripple");
            config.effects.push_back({ripple, 1, {0.02, 0.01, 3}});
            Plant plant(config);
            for (int step = 0; step < 3000; ++step) {
                const double duty = step < 2000 ? 0.5 : -0.3;
                for (int wheel = 0; wheel < wheel_count; ++wheel) plant.set_duty(wheel, duty + 0.05 * (wheel % 2));
                plant.step();
            }
            std::printf("%s %d %016" PRIx64 "\n", name, static_cast<int>(law), plant.state_hash());
        }
    return 0;
}
