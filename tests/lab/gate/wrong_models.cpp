// The rows of wrong models.
#include "spoil.h"

#include "host_tools/rover/rover.h"

namespace traction::gate {

const std::vector<Row> &wrong_models() {
    using lab::Model;
    const auto motor = [](const char *key, double factor) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) {
                if (w.motor.count(key) == 0) continue;
                lab::Parameter &p = w.motor.at(key);
                p.value *= factor, p.prior *= factor;
            }
        };
    };
    const auto geometry = [](const char *key, double factor) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) w.geometry.at(key).value *= factor, w.geometry.at(key).prior *= factor;
        };
    };
    const auto back_emf = [](double factor) { // where the sheet has none it is the torque constant's number
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) {
                auto p = w.motor.find("back_emf_Vs_rad");
                if (p == w.motor.end()) p = w.motor.emplace("back_emf_Vs_rad", w.motor.at("torque_constant_Nm_A")).first;
                if (!(p->second.value > 0)) p->second = w.motor.at("torque_constant_Nm_A");
                p->second.value *= factor, p->second.prior *= factor;
            }
        };
    };
    const auto soil_times = [](const char *key, double factor) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel)
                if (w.soil.count(key) != 0) w.soil.at(key).value *= factor, w.soil.at(key).prior *= factor;
        };
    };
    const auto soil = [](const char *key, double value) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) w.soil.at(key).value = value;
        };
    };
    const auto rover = [](const char *key, double factor) {
        return [=](Model &m) { m.rover.at(key).value *= factor, m.rover.at(key).prior *= factor; };
    };
    static const std::vector<Row> rows = {
        {"mass x 2", {}, rover("mass_kg", 2)},
        {"mass x 5", {}, rover("mass_kg", 5)},
        {"mass / 3", {}, rover("mass_kg", 1.0 / 3)},
        {"mass in g", {}, rover("mass_kg", 1000)},
        {"radius x 2", {}, geometry("radius_m", 2)},
        {"radius / 2", {}, geometry("radius_m", 0.5)},
        {"radius x 1.4", {}, geometry("radius_m", 1.4)},
        {"radius is the diameter's in mm / 50", {}, geometry("radius_m", 20)},
        {"torque constant x 2", {}, motor("torque_constant_Nm_A", 2)},
        {"torque constant / 3", {}, motor("torque_constant_Nm_A", 1.0 / 3)},
        {"torque constant of the motor's side of the gear", {}, motor("torque_constant_Nm_A", 0.02)},
        {"resistance x 5", {}, motor("resistance_ohm", 5)},
        {"resistance / 5", {}, motor("resistance_ohm", 0.2)},
        {"inertia x 30", {}, motor("inertia_kg_m2", 30)},
        {"friction x 20", {}, motor("coulomb_Nm", 20)},
        {"counts of half a turn",
         {},
         [](Model &m) { m.sensors["encoder.counts_per_turn"].value *= 2, m.sensors["encoder.counts_per_turn"].given = true; }},
        {"counts of the motor's turn",
         {},
         [](Model &m) { m.sensors["encoder.counts_per_turn"].value /= 50, m.sensors["encoder.counts_per_turn"].given = true; }},
        {"ground without grip", {}, soil("mu", 0.05)},
        {"ground that resists with half the weight", {}, soil("rolling_coefficient", 0.5)},
        {"left and right exchanged",
         {},
         [](Model &m) {
             for (lab::WheelSpec &w : m.wheel) w.geometry.at("y_m").value *= -1;
         }},
        {"one wheel of four", {}, [](Model &m) { m.wheel.resize(1); }},
        {"mass / 2", {}, rover("mass_kg", 0.5)},
        {"mass x 1.6", {}, rover("mass_kg", 1.6)},
        {"radius in cm", {}, geometry("radius_m", 100)},
        {"radius in mm", {}, geometry("radius_m", 1000)},
        {"radius / 1.4", {}, geometry("radius_m", 1 / 1.4)},
        {"torque constant in mNm/A", {}, motor("torque_constant_Nm_A", 1000)},
        {"torque constant in oz in/A", {}, motor("torque_constant_Nm_A", 141.6)},
        {"torque constant / 2", {}, motor("torque_constant_Nm_A", 0.5)},
        {"back-EMF in V per 1000 turns a minute", {}, back_emf(1000 * 2 * 3.141592653589793 / 60)},
        {"back-EMF / 2", {}, back_emf(0.5)},
        {"back-EMF x 2", {}, back_emf(2)},
        {"resistance in mOhm", {}, motor("resistance_ohm", 1000)},
        {"resistance / 2", {}, motor("resistance_ohm", 0.5)},
        {"resistance x 3", {}, motor("resistance_ohm", 3)},
        {"inertia of the motor's side of the gear", {}, motor("inertia_kg_m2", 0.0025)},
        {"inertia in kg cm2", {}, motor("inertia_kg_m2", 1e4)},
        {"inertia x 5", {}, motor("inertia_kg_m2", 5)},
        {"friction / 20", {}, motor("coulomb_Nm", 0.05)},
        {"friction x 5", {}, motor("coulomb_Nm", 5)},
        {"viscous friction x 100", {}, motor("viscous_Nms", 100)},
        {"a gear of half the ratio",
         {},
         [=](Model &m) {
             motor("torque_constant_Nm_A", 0.5)(m), motor("inertia_kg_m2", 0.25)(m), motor("viscous_Nms", 0.25)(m),
                 motor("coulomb_Nm", 0.5)(m);
         }},
        {"a gear of twice the ratio",
         {},
         [=](Model &m) {
             motor("torque_constant_Nm_A", 2)(m), motor("inertia_kg_m2", 4)(m), motor("viscous_Nms", 4)(m), motor("coulomb_Nm", 2)(m);
         }},
        {"ground x 5 as stiff", {}, soil_times("shear_slip", 0.2)},
        {"ground of a fifth the stiffness", {}, soil_times("shear_slip", 5)},
        {"ground with a third of the grip", {}, soil_times("mu", 1.0 / 3)},
        {"ground that resists five times as much", {}, soil_times("rolling_coefficient", 5)},
        {"the other ground",
         {},
         [](Model &m) {
             const bool sand = m.name.find("sand") != std::string::npos;
             const Model other = lab::read_model(sand ? "models/rover_concrete.toml" : "tests/lab/campaign/machine_sand.toml");
             for (std::size_t i = 0; i < m.wheel.size(); ++i) m.wheel[i].soil = other.wheel[i].soil;
         }},
        {"track halved",
         {},
         [](Model &m) {
             for (lab::WheelSpec &w : m.wheel) w.geometry.at("y_m").value *= 0.5;
         }},
        {"another robot", {}, [](Model &m) { m = lab::read_model("models/robotino.toml"); }},
        {"a rover twenty times as heavy",
         {},
         [](Model &m) { m = lab::parse_model(traction::model_text(sim::read_rover_file("rovers/heavy.toml"), "sand"), "heavy"); }},
    };
    return rows;
}

} // namespace traction::gate
