// What belongs to a run and not to the machine: offsets of its sensors, and its ground where the model's file states one.
#include "host_tools/lab/answer.h"
#include "host_tools/lab/between_runs.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/session.h"
#include "host_tools/lab/validate.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

constexpr double duration_s = 40;

GeneratorConfig machine(Soil soil, std::uint64_t seed, int run) {
    GeneratorConfig config;
    config.soil = soil, config.seed = seed, config.run = run, config.duration_s = duration_s;
    config.apart = true;
    return config;
}

log::Log drive(Soil soil, std::uint64_t seed, int run, double accel_offset = 0, double gyro_offset = 0) {
    static std::map<std::tuple<Soil, std::uint64_t, int>, log::Log> made;
    const auto [found, anew] = made.try_emplace({soil, seed, run});
    if (anew) found->second = generator::generate(machine(soil, seed, run));
    log::Log log = found->second;
    for (log::Signal &s : log.signals)
        for (double &value : s.value) value += s.name == "imu.accel_x_m_s2" ? accel_offset : s.name == "imu.gyro_z_rad_s" ? gyro_offset : 0;
    return log;
}

// Logs that are held in memory, by their files' names.
struct Logs {
    std::map<std::string, log::Log> log;

    Request request(const std::vector<std::string> &files) const {
        Request asked;
        asked.model = "sheet", asked.logs = files;
        asked.read = [this](const std::string &file, const std::string &, std::vector<log::Repair> &) {
            log::Log found = log.at(file);
            found.source = file;
            return found;
        };
        return asked;
    }
    Session open(const Model &model, const std::vector<std::string> &files) const { return open_session(request(files), model); }
};

std::string sheet(Soil soil, std::uint64_t seed) { return generator::data_sheet(machine(soil, seed, 0)); }

const RunSpec &run_of(const Model &model, const std::string &log) {
    return *std::find_if(model.runs.begin(), model.runs.end(), [&](const RunSpec &run) { return run.log == log; });
}

bool has(const Model &model, const std::string &name) {
    const std::vector<FreeParameter> list = free_parameters(model, make_physics(model));
    return std::any_of(list.begin(), list.end(), [&](const FreeParameter &p) { return name_of(p) == name; });
}

TEST(Runs, each_has_an_offset_of_its_own_and_the_machine_has_none_beside_them) {
    const Logs logs{{{"a.csv", drive(Soil::concrete, 31, 0)}, {"b.csv", drive(Soil::concrete, 31, 1, 0.15, -0.004)}}};
    const Model model = parse_model(sheet(Soil::concrete, 31), "sheet");
    const Session one = logs.open(model, {"a.csv"}), two = logs.open(model, {"a.csv", "b.csv"});
    EXPECT_TRUE(has(one.model, "sensors.accel.bias_m_s2"));
    EXPECT_FALSE(has(one.model, "sensors.accel.bias_m_s2 in a.csv"));
    EXPECT_FALSE(has(two.model, "sensors.accel.bias_m_s2"));
    for (const char *name : {"sensors.accel.bias_m_s2 in a.csv", "sensors.accel.bias_m_s2 in b.csv", "sensors.gyro.bias_rad_s in a.csv",
                             "sensors.gyro.bias_rad_s in b.csv", "soil.mu", "sensors.accel.delay_s"})
        EXPECT_TRUE(has(two.model, name)) << name;

    // the second run's offsets move its rows, and no others
    Model moved = two.model;
    for (RunSpec &run : moved.runs)
        if (run.log == "b.csv") run.sensors.at("accel.bias_m_s2").value = 0.2, run.sensors.at("gyro.bias_rad_s").value = 0.01;
    Forward forward(two.data);
    const Eigen::VectorXd change = forward.predict(make_physics(moved)) - forward.predict(make_physics(two.model));
    Eigen::Index row = 0;
    std::size_t first = 0, second = 0;
    for (const Balance &b : two.data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const bool in_second = b.t0_s[r] > two.data.run_start_s[1] - 1e-6;
            const double offset = b.kind == BalanceKind::accel ? 0.2 : b.kind == BalanceKind::yaw_rate ? 0.01 : 0;
            if (offset > 0) ++(in_second ? second : first);
            EXPECT_NEAR(change[row], in_second ? offset : 0, 1e-9) << b.name << " at " << b.t0_s[r];
        }
    EXPECT_GT(first, 500U);
    EXPECT_GT(second, 500U);
}

TEST(Runs, an_offset_that_is_another_in_one_run_is_found_there_and_is_no_effect) {
    const Logs logs{{{"a.csv", drive(Soil::concrete, 31, 0)},
                     {"b.csv", drive(Soil::concrete, 31, 1)},
                     {"off.csv", drive(Soil::concrete, 31, 1, 0.15, -0.004)}}};
    const Model model = parse_model(sheet(Soil::concrete, 31), "sheet");
    const Session plain = logs.open(model, {"a.csv", "b.csv"}), off = logs.open(model, {"a.csv", "off.csv"});
    Model as_it_was = plain.model, shifted = off.model;
    fit_model(as_it_was, plain.data, "plain"), fit_model(shifted, off.data, "off");
    const auto bias = [](const Model &fitted, const char *log, const char *key) { return run_of(fitted, log).sensors.at(key).value; };
    EXPECT_NEAR(bias(shifted, "off.csv", "accel.bias_m_s2") - bias(as_it_was, "b.csv", "accel.bias_m_s2"), 0.15, 0.003);
    EXPECT_NEAR(bias(shifted, "off.csv", "gyro.bias_rad_s") - bias(as_it_was, "b.csv", "gyro.bias_rad_s"), -0.004, 1e-4);
    EXPECT_NEAR(bias(shifted, "a.csv", "accel.bias_m_s2"), bias(as_it_was, "a.csv", "accel.bias_m_s2"), 0.003);
    EXPECT_EQ(shifted.sensors.at("accel.bias_m_s2").value, 0);

    const Answer answer = diagnose_answer(off, logs.request({"a.csv", "off.csv"}), {}, false);
    EXPECT_EQ(answer.kind, "nothing") << answer.text;
}

// On sand, then on gravel, with the table's numbers of both.
std::string two_grounds(std::uint64_t seed) {
    const Model gravel = parse_model(sheet(Soil::gravel, seed), "gravel");
    std::string text = sheet(Soil::sand, seed) + "\n[[run]]\nlog = \"gravel.csv\"\n[run.soil]\n";
    for (const char *key : {"mu", "shear_slip", "rolling_coefficient"}) {
        const Parameter &p = gravel.wheel[0].soil.at(key);
        text += std::string(key) + " = { value = " + std::to_string(p.value) + ", prior = " + std::to_string(p.prior) + " }\n";
    }
    return text;
}

TEST(Runs, a_ground_that_the_file_states_is_that_runs) {
    const Logs logs{{{"sand.csv", drive(Soil::sand, 42, 0)}, {"gravel.csv", drive(Soil::gravel, 42, 1)}}};
    const std::vector<std::string> both = {"sand.csv", "gravel.csv"};
    const Session one = logs.open(parse_model(sheet(Soil::sand, 42), "sheet"), both);
    const Session own = logs.open(parse_model(two_grounds(42), "sheet"), both);
    Model shared = one.model, apart = own.model, alone = logs.open(parse_model(sheet(Soil::gravel, 42), "sheet"), {"gravel.csv"}).model;
    const double with_one = fit_model(shared, one.data, "one").train, with_own = fit_model(apart, own.data, "own").train;
    const Session gravel = logs.open(alone, {"gravel.csv"});
    const double by_itself = fit_model(alone, gravel.data, "alone").train;
    EXPECT_LT(with_own, 1.3 * by_itself); // as well as a model of one ground describes a log of one ground
    EXPECT_GT(with_one, 3 * with_own);
    const Parameter &mu = run_of(apart, "gravel.csv").soil.at("mu"), &of_one = alone.wheel[0].soil.at("mu");
    EXPECT_LT(std::fabs(mu.value - of_one.value), mu.high - mu.low);
    EXPECT_TRUE(run_of(apart, "sand.csv").soil.empty());

    const Answer answer = diagnose_answer(own, logs.request(both), {}, false);
    EXPECT_EQ(answer.kind, "nothing") << answer.text;
}

TEST(Runs, none_is_predicted_better_where_each_that_was_left_out_is_not) {
    const Validation better{"a.csv", 9, 3, 2, true}, worse{"b.csv", 9, 3, 3.1, true}, as_well{"c.csv", 9, 3, 3, true},
        unseen{"d.csv", 9, 3, 2, false};
    EXPECT_TRUE(predicts_no_run({worse, as_well}));
    EXPECT_TRUE(predicts_no_run({worse, unseen})); // given by --validate: not what the question is of
    EXPECT_FALSE(predicts_no_run({worse, better}));
    EXPECT_FALSE(predicts_no_run({unseen}));
    EXPECT_FALSE(predicts_no_run({}));
}

TEST(Runs, a_name_that_predicts_no_run_that_was_left_out_is_said_to) {
    const Logs logs{{{"sand.csv", drive(Soil::sand, 42, 0)}, {"gravel.csv", drive(Soil::gravel, 42, 1)}}};
    const std::vector<std::string> both = {"sand.csv", "gravel.csv"};
    const Session one = logs.open(parse_model(sheet(Soil::sand, 42), "sheet"), both);
    const Answer as_one = diagnose_answer(one, logs.request(both), {}, false);
    ASSERT_FALSE(as_one.json.at("accepted").empty())
        << as_one.text; // a soft place where the second run begins: of this joined log it is true
    bool told = false;
    for (const auto &message : as_one.json.at("messages"))
        told = told || message.get<std::string>().find("no run that was left out is predicted better") == 0;
    EXPECT_TRUE(told) << as_one.text;
}

// Left out in turn, or judged on alone: by its own ground, as stated and found there.
TEST(Runs, a_run_that_is_judged_stands_on_its_own_ground) {
    const Logs logs{{{"sand.csv", drive(Soil::sand, 42, 0)}, {"gravel.csv", drive(Soil::gravel, 42, 1)}}};
    const std::vector<std::string> both = {"sand.csv", "gravel.csv"};
    const Session one = logs.open(parse_model(sheet(Soil::sand, 42), "sheet"), both);
    const Session own = logs.open(parse_model(two_grounds(42), "sheet"), both);
    const std::vector<Validation> shared = validate(one, logs.request(both), one.model),
                                  apart = validate(own, logs.request(both), own.model);
    ASSERT_EQ(apart.size(), 2U);
    for (std::size_t i = 0; i < apart.size(); ++i) EXPECT_GT(shared[i].fitted, 3 * apart[i].fitted) << apart[i].log;

    Request later = logs.request({"sand.csv"});
    later.validate = {"gravel.csv"};
    const Session first = logs.open(parse_model(two_grounds(42), "sheet"), {"sand.csv"});
    const std::vector<Validation> judged = validate(first, later, first.model);
    ASSERT_EQ(judged.size(), 1U);
    EXPECT_LT(judged[0].fitted, 1.5 * apart[1].fitted);
}

// (1) of between_runs.h, by hand, and a stiffness that two grounds give: it differs, what the machine has does not.
TEST(Runs, fits_of_each_alone_tell_what_is_no_constant_of_the_machine) {
    const Logs logs{{{"sand.csv", drive(Soil::sand, 42, 0)}, {"gravel.csv", drive(Soil::gravel, 42, 1)}}};
    const Session session = logs.open(parse_model(sheet(Soil::sand, 42), "sheet"), {"sand.csv", "gravel.csv"});
    const std::vector<BetweenRuns> list = between_runs(session);
    ASSERT_GT(list.size(), 20U);
    bool stiffness = false;
    for (const BetweenRuns &one : list) {
        ASSERT_EQ(one.value.size(), 2U) << one.parameter;
        const double variance = (std::pow(one.half_width[0], 2) + std::pow(one.half_width[1], 2)) / std::pow(1.96, 2);
        EXPECT_NEAR(one.times, std::fabs(one.value[0] - one.value[1]) / std::sqrt(variance), 1e-9 * one.times) << one.parameter; // of two
        EXPECT_EQ(one.parameter.find(" in "), std::string::npos) << one.parameter; // a run's own is no question
        EXPECT_TRUE(one.differs == false || one.parameter.rfind("soil.", 0) == 0) << one.parameter << " " << one.times;
        stiffness = stiffness || (one.parameter == "soil.shear_slip" && one.differs);
    }
    EXPECT_TRUE(stiffness);
    const std::string text = between_runs_text(list);
    EXPECT_NE(text.find("beyond chance differ\n"), std::string::npos) << text;
    EXPECT_NE(text.find("  soil.shear_slip"), std::string::npos) << text;
    EXPECT_TRUE(between_runs(logs.open(session.model, {"sand.csv"})).empty());
}

TEST(Runs, logs_of_one_name_are_told_apart_by_their_folders) {
    const log::Log log = drive(Soil::concrete, 31, 0);
    const Logs logs{{{"/data/monday/log.csv", log}, {"/data/friday/log.csv", drive(Soil::concrete, 31, 1)}}};
    const Session session = logs.open(parse_model(sheet(Soil::concrete, 31), "sheet"), {"/data/monday/log.csv", "/data/friday/log.csv"});
    ASSERT_EQ(session.model.runs.size(), 2U);
    EXPECT_EQ(session.model.runs[0].log, "monday/log.csv");
    EXPECT_EQ(session.model.runs[1].log, "friday/log.csv");
    const Session again = logs.open(parse_model(model_text(session.model), "written"), {"/data/friday/log.csv"});
    ASSERT_EQ(again.model.runs.size(), 2U);
    EXPECT_TRUE(std::isnan(again.model.runs[0].start_s));
    EXPECT_FALSE(std::isnan(again.model.runs[1].start_s));
}

TEST(Runs, a_name_that_two_logs_have_is_refused_and_so_is_one_drive_given_twice) {
    const log::Log log = drive(Soil::concrete, 31, 0);
    const Logs logs{{{"/data/monday/log.csv", log}, {"/data/friday/log.csv", drive(Soil::concrete, 31, 1)}}};
    const Model named = parse_model(sheet(Soil::concrete, 31) + "\n[[run]]\nlog = \"log.csv\"\n[run.soil]\nmu = 0.7\n", "sheet.toml");
    try {
        logs.open(named, {"/data/monday/log.csv", "/data/friday/log.csv"});
        ADD_FAILURE() << "one ground for two logs";
    } catch (const ModelError &error) {
        EXPECT_EQ(error.key, "run.log") << error.what();
        EXPECT_NE(error.mend.find("path"), std::string::npos) << error.what();
    }
    for (const char *again : {"/data/monday/log.csv", "/data/tuesday/copy.csv"}) { // the same samples, whatever the file is called
        const Logs copies{{{"/data/monday/log.csv", log}, {"/data/tuesday/copy.csv", log}}};
        try {
            copies.open(parse_model(sheet(Soil::concrete, 31), "sheet"), {"/data/monday/log.csv", again});
            ADD_FAILURE() << again << " is no second run";
        } catch (const ModelError &error) {
            EXPECT_EQ(error.key, "--log") << error.what();
        }
    }
}

// Windings cool between runs, and what fades begins anew: the same drive again is predicted as at first. `from_s`: of the run, on.
void expect_same_again(const std::string &effect, BalanceKind kind, double from_s) {
    const log::Log log = drive(Soil::sand, 42, 0);
    log::Log again = log;
    again.signals.back().value.back() += 1e-9; // the very same samples would be no second run
    const Logs logs{{{"a.csv", log}, {"b.csv", again}}};
    const Session session =
        logs.open(parse_model(sheet(Soil::sand, 42) + "\n[[effect]]\nname = " + effect + "\n", "sheet"), {"a.csv", "b.csv"});
    const Eigen::VectorXd predicted = Forward(session.data).predict(make_physics(session.model));
    Eigen::Index row = 0;
    std::size_t compared = 0;
    for (const Balance &b : session.data.balance) {
        std::map<long, double> first; // by the time within the run, in ms
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const bool second = b.t0_s[r] > session.data.run_start_s[1] - 1e-6;
            const double t = b.t0_s[r] - session.data.run_start_s[second ? 1 : 0];
            if (b.kind != kind || t < from_s || t > 38) continue;
            if (!second) first[std::lround(1000 * t)] = predicted[row];
            const auto found = first.find(std::lround(1000 * t));
            if (!second || found == first.end()) continue;
            EXPECT_NEAR(predicted[row], found->second, 2e-4) << b.name << " at " << t;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500U);
}

TEST(Runs, each_begins_with_cold_windings) {
    expect_same_again("\"winding_heating\"\nresistance_K_W = 10\ntime_constant_s = 60", BalanceKind::current_voltage, 25); // warm by then
}

TEST(Runs, each_begins_with_what_fades) {
    expect_same_again("\"wear_in\"\ntorque_Nm = 0.05\ntime_constant_s = 80", BalanceKind::current_torque, 5);
}

TEST(Runs, are_written_as_they_are_read) {
    const Model model = parse_model(sheet(Soil::sand, 1) + R"(
[[run]]
log = "wet.csv"
[run.soil]
mu = { value = 0.4, prior = 0.05, low = 0.3, high = 0.5 }
shear_slip = 0.2
[run.sensors.accel]
bias_m_s2 = 0.03
[run.sensors.gyro]
bias_rad_s = { value = 0.001, fixed = true }
)",
                                    "sheet");
    ASSERT_EQ(model.runs.size(), 1U);
    const Model again = parse_model(model_text(model), "written");
    ASSERT_EQ(again.runs.size(), 1U);
    const RunSpec &run = again.runs.front();
    EXPECT_EQ(run.log, "wet.csv");
    EXPECT_EQ(run.soil.at("mu").value, 0.4);
    EXPECT_EQ(run.soil.at("mu").prior, 0.05);
    EXPECT_EQ(run.soil.at("mu").high, 0.5);
    EXPECT_NEAR(run.soil.at("shear_slip").prior, 0.15 * 0.2, 1e-12); // as a [soil] has it
    EXPECT_EQ(run.sensors.at("accel.bias_m_s2").value, 0.03);
    EXPECT_TRUE(run.sensors.at("gyro.bias_rad_s").fixed);
}

TEST(Runs, a_mistake_is_told_with_its_line_and_mend) {
    const struct {
        const char *text, *key, *mend;
    } mistakes[] = {
        {"[[run]]\n[run.soil]\nmu = 0.4\n", "run[0].log", "name the run's log file"},
        {"[run]\nlog = \"a.csv\"\n", "run", "write [[run]]"},
        {"[[run]]\nlog = \"a.csv\"\n[run.motor]\nresistance_ohm = 1\n", "run[0].motor", "soil and sensors"},
        {"[[run]]\nlog = \"a.csv\"\n[run.soil]\nmuu = 1\n", "run[0].soil.muu", "did you mean mu"},
        {"[[run]]\nlog = \"a.csv\"\n[run.soil]\nlateral_grip = 1\n", "run[0].soil.lateral_grip", "of its own"},
        {"[[run]]\nlog = \"a.csv\"\n[run.sensors.radar]\nscale = 0.1\n", "run[0].sensors.radar.scale", "of its own"},
        {"[[run]]\nlog = \"a.csv\"\n[[run]]\nlog = \"a.csv\"\n", "run[1].log", "one [[run]] for each log"},
    };
    const std::string good = sheet(Soil::sand, 1) + "\n";
    for (const auto &m : mistakes) {
        try {
            parse_model(good + m.text, "sheet");
            ADD_FAILURE() << m.text;
        } catch (const ModelError &error) {
            EXPECT_EQ(error.key, m.key) << error.what();
            EXPECT_NE(error.mend.find(m.mend), std::string::npos) << error.what();
            EXPECT_GT(error.line, 0U) << error.what();
        }
    }
}

} // namespace
} // namespace traction::lab
