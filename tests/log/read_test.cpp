// Reading and writing logs: each kind of bad input has its message (line, column, value, mend) or its stated repair.
#include "files.h"

#include "host_tools/log/read.h"
#include "host_tools/log/vocabulary.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

using namespace traction::log;
using traction::test::File;

namespace {

const std::string head = "# format: traction-log 1\n# seed: 7\nt_s,wheel0.speed_rad_s,camera.x_m\n";

// The message of the LogError, without the folder of the file.
std::string refusal(const std::string &text, const ReadLimits &limits = {}) {
    const File file("log.csv", text);
    try {
        std::vector<Repair> repairs;
        read_csv(file.path(), "", repairs, limits);
    } catch (const LogError &error) {
        std::string message = error.what();
        const std::size_t at = message.find(file.path());
        if (at != std::string::npos) message.replace(at, file.path().size(), "log.csv");
        return message;
    }
    return "(read without complaint)";
}

struct Read {
    Log log;
    std::vector<Repair> repairs;
    const Repair *find(const std::string &id) const {
        for (const Repair &repair : repairs) {
            if (repair.id == id) return &repair;
        }
        return nullptr;
    }
};

Read read(const std::string &text) {
    const File file("log.csv", text);
    Read out;
    out.log = read_csv(file.path(), "", out.repairs);
    EXPECT_EQ(out.log.repairs.size(), out.repairs.size());
    return out;
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

} // namespace

TEST(Read, a_good_log_needs_no_repair_and_keeps_every_rate) {
    const Read r = read(head + "0,1.5,\n0.01,1.25,0.5\n0.02,-1e-3,\n");
    EXPECT_TRUE(r.repairs.empty());
    EXPECT_EQ(r.log.header.at("seed"), "7");
    EXPECT_EQ(r.log.header.count("format"), 0u);
    ASSERT_EQ(r.log.signals.size(), 2u);
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{1.5, 1.25, -1e-3}));
    EXPECT_EQ(r.log.find("camera.x_m")->t_s, (std::vector<double>{0.01}));
    EXPECT_EQ(r.log.find("nothing"), nullptr);
    EXPECT_DOUBLE_EQ(r.log.duration_s(), 0.02);
}

TEST(Read, a_missing_file_is_a_file_error_that_names_it) {
    try {
        read_csv("/nonexistent/log.csv");
        FAIL();
    } catch (const FileError &error) {
        EXPECT_STREQ(error.what(),
                     "/nonexistent/log.csv: cannot be opened: No such file or directory; to mend: check the path and its permissions");
    }
}

TEST(Read, a_folder_is_refused) { EXPECT_THROW(read_csv("/"), FileError); }

TEST(Read, an_empty_file_is_refused) {
    EXPECT_EQ(refusal(""), "log.csv: the file is empty; to mend: check the recording, or name another file");
    EXPECT_HAS(refusal("# format: traction-log 1\n"), "there is no row of names and no data");
    EXPECT_EQ(refusal("# format: traction-log 1\nt_s,wheel0.speed_rad_s\n\n"),
              "log.csv, line 2: below the row of names there is no row of data; to mend: check the recording, or name another file");
}

TEST(Read, a_binary_file_is_refused_by_what_it_is) {
    using namespace std::string_literals;
    EXPECT_HAS(refusal("\x01\x02\x00\x03"s), "this is not a text file");
    EXPECT_HAS(refusal("\xD4\xC7, \x12\x16\n1,2\n"), "this is not a text file");
    EXPECT_HAS(refusal("t_s,wheel0.speed_rad_s\n0,\0\n"s), "this is not a text file");
    EXPECT_HAS(refusal("t_s,wheel0.speed_rad_s\r0,1\r"), "its lines end with CR alone");
    EXPECT_HAS(refusal("PK\x03\x04"), "this is a zip archive or a spreadsheet; to mend: unpack it, or export the sheet as CSV");
    EXPECT_HAS(refusal("\xFF\xFEt\0_\0s\0"s), "this is text in UTF-16; to mend: save it as UTF-8");
    EXPECT_HAS(refusal("\xFE\xFF\0t\0_\0s"s), "this is text in UTF-16; to mend: save it as UTF-8");
    EXPECT_HAS(refusal("\x1F\x8B\x08\x00"s), "this is packed by gzip");
    EXPECT_HAS(refusal("#ROSBAG V2.0\nE\0\0\0"s), "this is a ROS bag; to mend: export its topics as CSV");
    EXPECT_HAS(refusal("SQLite format 3\0\x10\0"s), "this is an SQLite database, as bags of ROS 2 are");
    EXPECT_HAS(refusal("\x89MCAP0\r\n"), "this is an MCAP file, which is written here and not read");
    EXPECT_HAS(refusal("\x89HDF\r\n\x1A\n"), "this is an HDF5 file");
    EXPECT_HAS(refusal("MATLAB 5.0 MAT-file"), "this is a MATLAB file; to mend: write the table as CSV");
    EXPECT_HAS(refusal("PAR1\x15\x04"), "this is a Parquet file");
}

TEST(Read, a_missing_row_of_names_is_refused) {
    EXPECT_EQ(refusal("0,1,2\n0.01,1,2\n"),
              "log.csv, line 1, column 1: there is no row of names: this first row begins with the number '0'; to mend: put "
              "'t_s,<object>.<quantity>_<unit>,...' above the data, or read the file through a map (--map)");
}

TEST(Read, a_missing_time_column_is_refused) {
    EXPECT_EQ(refusal("time,wheel0.speed_rad_s\n0,1\n"),
              "log.csv, line 1: there is no column 't_s' (found: time, wheel0.speed_rad_s); to mend: call the column of "
              "seconds 't_s', or read the file through a map (--map)");
}

TEST(Read, a_duplicate_column_is_refused) {
    EXPECT_EQ(refusal("t_s,camera.x_m,camera.x_m\n0,1,2\n"),
              "log.csv, line 1, column 3: column 'camera.x_m' stands twice, first as column 2; to mend: rename or delete one of them");
}

TEST(Read, a_nameless_column_is_refused) {
    EXPECT_HAS(refusal("t_s,,camera.x_m\n0,1,2\n"), "log.csv, line 1, column 2: this column has no name");
}

TEST(Read, a_wrong_format_version_is_refused) {
    EXPECT_EQ(refusal("# format: traction-log 9\nt_s\n"), "log.csv, line 1: format 'traction-log 9' is not known to this version; to mend: "
                                                          "write '# format: traction-log 1', or read it with the traction that wrote it");
}

TEST(Read, a_missing_format_line_is_a_stated_repair) { EXPECT_NE(read("t_s,camera.x_m\n0,1\n").find("no_format"), nullptr); }

TEST(Read, a_cell_that_is_no_number_is_refused_with_its_place) {
    EXPECT_EQ(refusal(head + "0,1,\n0.01,12a4,\n"),
              "log.csv, line 5, column 2: '12a4' in column 'wheel0.speed_rad_s' is not a number; to mend: write a number, or leave the "
              "cell empty where there is no sample");
    EXPECT_HAS(refusal(head + "0,1 2,\n"), "'1 2' in column");
    EXPECT_HAS(refusal(head + "0,0x10,\n"), "'0x10' in column");
}

TEST(Read, a_wrong_number_of_fields_is_refused) {
    EXPECT_EQ(refusal(head + "0,1\n0.01,1,\n"), "log.csv, line 4: 2 fields, but the row of names (line 3) has 3; to mend: give every row "
                                                "one field a column, empty where there is no sample");
    EXPECT_HAS(refusal(head + "0,1,5,2,5\n"), "decimal commas need ';' between columns");
}

TEST(Read, a_row_without_time_is_refused) { EXPECT_HAS(refusal(head + "0,1,\n,2,\n"), "log.csv, line 5, column 1: the row has no time"); }

TEST(Read, an_open_quote_is_refused) {
    EXPECT_HAS(refusal(head + "0,\"1,\n"), "log.csv, line 4, column 2: a quote is opened and never closed");
}

TEST(Read, nan_and_infinite_cells_become_no_sample_and_are_said) {
    const Read r = read(head + "0,nan,1\n0.01,inf,2\n0.02,3,NA\n0.03,-1e999,\n");
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{3}));
    ASSERT_NE(r.find("not_finite"), nullptr);
    EXPECT_EQ(r.find("not_finite")->text,
              "line 4, column 2: 3 cells of 'wheel0.speed_rad_s' are NaN, infinite or say 'none', read as no sample");
    EXPECT_EQ(r.find("not_finite")->count, 3u);
}

TEST(Read, a_time_that_is_not_finite_loses_its_row_and_is_said) {
    const Read r = read(head + "0,1,\nnan,2,\n0.02,3,\n");
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{1, 3}));
    EXPECT_EQ(r.repairs.at(0).text, "line 5, column 1: 1 rows have a time that is not finite, left out");
}

TEST(Read, duplicate_times_keep_the_first_and_are_said) {
    const Read r = read(head + "0,1,\n0.01,2,\n0.01,9,\n0.02,3,\n");
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(r.repairs.at(0).text,
              "line 6, column 2: 1 samples of 'wheel0.speed_rad_s' have a time already taken, the first of each is kept");
}

TEST(Read, rows_of_one_time_that_fill_different_columns_are_no_duplicates) {
    const Read r = read(head + "0,1,\n0,,5\n0.01,2,\n");
    EXPECT_TRUE(r.repairs.empty());
    EXPECT_EQ(r.log.find("camera.x_m")->value, (std::vector<double>{5}));
}

TEST(Read, unsorted_times_are_sorted_and_said) {
    const Read r = read(head + "0,1,\n0.02,3,\n0.01,2,\n0.03,4,\n");
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->t_s, (std::vector<double>{0, 0.01, 0.02, 0.03}));
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(r.repairs.at(0).text, "line 6, column 2: the times of 'wheel0.speed_rad_s' run back 1 times, sorted");
}

TEST(Read, a_clock_set_back_while_logging_is_refused_with_its_line) {
    std::string text = head;
    for (int i = 0; i < 200; ++i) text += std::to_string(i < 120 ? 0.01 * i : 0.01 * i - 0.5) + ",1,\n";
    EXPECT_HAS(refusal(text), "log.csv, line 124, column 2: the time of 'wheel0.speed_rad_s' jumps back from 1.19 s to 0.7 s and runs over "
                              "the same span again: the clock was set");
}

TEST(Read, blocks_in_the_wrong_order_are_no_clock_jump) {
    std::string text = head;
    for (int i = 0; i < 200; ++i) text += std::to_string(0.01 * ((i + 100) % 200)) + ",1,\n";
    EXPECT_NE(read(text).find("unsorted"), nullptr);
}

TEST(Read, a_cut_last_line_is_left_out_and_said) {
    const Read r = read(head + "0,1,\n0.01,2,\n0.02,3");
    EXPECT_EQ(r.log.find("wheel0.speed_rad_s")->value, (std::vector<double>{1, 2}));
    EXPECT_EQ(r.repairs.at(0).text, "line 6: the last line does not end with a line end and may be cut, left out");
}

TEST(Read, line_ends_byte_order_mark_and_blank_lines_are_mended) {
    const Read r = read("\xEF\xBB\xBF# format: traction-log 1\r\nt_s,camera.x_m\r\n0,1\r\n\r\n1,2\r\n\r\n");
    EXPECT_EQ(r.log.find("camera.x_m")->value, (std::vector<double>{1, 2}));
    EXPECT_NE(r.find("byte_order_mark"), nullptr);
    EXPECT_NE(r.find("crlf"), nullptr);
    EXPECT_EQ(r.find("blank_line")->text, "line 4: 1 blank lines between the rows are skipped");
}

TEST(Read, semicolons_and_decimal_commas_are_mended) {
    const Read r = read("# format: traction-log 1\nt_s;camera.x_m\n0,00;1,5\n0,01;-2,25e-1\n");
    EXPECT_EQ(r.log.find("camera.x_m")->value, (std::vector<double>{1.5, -0.225}));
    EXPECT_NE(r.find("separator"), nullptr);
    EXPECT_EQ(r.find("decimal_comma")->text, "line 3: 4 numbers have a decimal comma, read as a point");
}

TEST(Read, quotes_plus_signs_and_blanks_around_numbers_are_read) {
    const Read r = read("# format: traction-log 1\n\"t_s\", \"camera.x_m\"\n0,\"+1.5\"\n1, 2 \n");
    EXPECT_EQ(r.log.find("camera.x_m")->value, (std::vector<double>{1.5, 2}));
    EXPECT_TRUE(r.repairs.empty());
}

TEST(Read, a_separator_at_the_end_of_lines_is_mended) {
    EXPECT_NE(read("# format: traction-log 1\nt_s,camera.x_m,\n0,1,\n").find("trailing_separator"), nullptr);
    EXPECT_NE(read("# format: traction-log 1\nt_s,camera.x_m\n0,1,\n").find("trailing_separator"), nullptr);
}

TEST(Read, an_unknown_name_is_kept_and_said) {
    const Read r = read("# format: traction-log 1\nt_s,arm.joint_rad,camera.x_m\n0,1,2\n");
    EXPECT_NE(r.log.find("arm.joint_rad"), nullptr);
    EXPECT_EQ(r.find("unknown_name")->text,
              "1 column is not in the vocabulary ('arm.joint_rad'): kept under their own names, used by no balance");
    const Read foreign = read("t_s,a,b\n0,1,2\n");
    EXPECT_EQ(foreign.find("unknown_name")->text, "no column is in the vocabulary ('a', 'b'): a foreign file wants a map (--map)");
}

TEST(Read, a_mistyped_name_is_told_with_what_it_was_to_be) {
    const auto told = [](const std::string &columns) {
        return read("# format: traction-log 1\nt_s," + columns + "\n0,1,2\n").find("unknown_name")->text;
    };
    EXPECT_NE(told("wheel2.current_a,camera.x_m").find("'wheel2.current_a' (did you mean 'wheel2.current_A'?)"), std::string::npos);
    EXPECT_NE(told("whel11.speed_rad_s,camera.x_m").find("(did you mean 'wheel11.speed_rad_s'?)"), std::string::npos);
    EXPECT_NE(told("imu.acel_x_m_s2,camera.x_m").find("(did you mean 'imu.accel_x_m_s2'?)"), std::string::npos);
    EXPECT_EQ(told("camera.x,camera.x_m").find("did you mean 'camera.x_m'"), std::string::npos); // which the file has
    EXPECT_EQ(told("arm.joint_rad,camera.x_m").find("did you mean"), std::string::npos);
}

TEST(Read, a_known_quantity_in_another_unit_is_converted_and_said) {
    const Read r =
        read("# format: traction-log 1\nt_s,wheel0.speed_rpm,wheel0.current_mA,imu.gyro_z_deg_s,camera.x_furlong\n0,60,250,180,1\n");
    EXPECT_NEAR(r.log.find("wheel0.speed_rad_s")->value[0], 6.283185307179586, 1e-14); // 60 rpm is 2 pi rad/s; 1e-14: a few roundings of 7
    EXPECT_DOUBLE_EQ(r.log.find("wheel0.current_A")->value[0], 0.25);
    EXPECT_NEAR(r.log.find("imu.gyro_z_rad_s")->value[0], 3.141592653589793, 1e-14);
    EXPECT_EQ(r.find("unit_converted")->text, "column 2: 'wheel0.speed_rpm' is converted to 'wheel0.speed_rad_s' by the factor 0.1047198");
    EXPECT_NE(r.log.find("camera.x_furlong"), nullptr); // an unknown unit is an unknown name
    EXPECT_NE(r.find("unknown_name"), nullptr);
}

TEST(Read, a_file_or_a_number_of_samples_beyond_the_limit_is_refused) {
    ReadLimits limits;
    limits.bytes = 1 << 20;
    EXPECT_EQ(refusal(std::string(3 << 20, 'x'), limits),
              "log.csv: is too large: 3 MiB, the limit is 1 MiB; to mend: cut it into parts, or leave out the fastest columns");
    limits.samples = 2;
    EXPECT_HAS(refusal(head + "0,1,1\n1,1,1\n", limits), "log.csv, line 5, column 2: the log holds more than 2 samples");
}

TEST(Read, a_log_of_120_s_with_sixty_columns_reads_back_the_same) {
    Log log;
    for (int k = 0; k < 60; ++k) {
        Signal signal{"wheel" + std::to_string(k) + ".speed_rad_s", {}, {}};
        const int count = k == 0 ? 61440 : 12000 / (1 + k % 8);
        for (int i = 0; i < count; ++i) {
            signal.t_s.push_back(120.0 * i / count);
            signal.value.push_back(0.001 * i + k / 3.0);
        }
        log.signals.push_back(std::move(signal));
    }
    const File file("speed.csv", "");
    write_csv(log, file.path());
    const Log again = read_csv(file.path());
    ASSERT_EQ(again.signals.size(), log.signals.size());
    for (std::size_t k = 0; k < log.signals.size(); ++k) {
        EXPECT_EQ(again.signals[k].t_s, log.signals[k].t_s);
        EXPECT_EQ(again.signals[k].value, log.signals[k].value);
    }
}

// Other readers of CSV take the first line for the names, and a line of another number of fields for none of theirs.
TEST(Write, the_names_are_the_first_line_and_the_header_follows) {
    Log log;
    log.header["seed"] = "7";
    log.signals = {{"wheel0.speed_rad_s", {0, 0.01}, {1, 2}}, {"camera.x_m", {0.01}, {0.5}}};
    const File file("names_first.csv", "");
    write_csv(log, file.path());
    std::ifstream in(file.path());
    std::string text(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(text, "t_s,wheel0.speed_rad_s,camera.x_m\n# format: traction-log 1\n# seed: 7\n0,1,\n0.01,2,0.5\n");
    const Log again = read_csv(file.path());
    EXPECT_EQ(again.header.at("seed"), "7");
    EXPECT_TRUE(again.repairs.empty());
}

TEST(Write, refuses_what_could_not_be_read_back_and_leaves_no_file) {
    const std::string path = ::testing::TempDir() + "traction_never.csv";
    const auto refusal_of = [&](const Log &log) {
        try {
            write_csv(log, path);
        } catch (const LogError &error) {
            return std::string(error.what());
        }
        return std::string("(written)");
    };
    Log log;
    log.signals = {{"a.b_m", {0, 0}, {1, 2}}};
    EXPECT_HAS(refusal_of(log), "times of 'a.b_m' do not increase at sample 1");
    log.signals = {{"a.b_m", {0, 1}, {1, std::nan("")}}};
    EXPECT_HAS(refusal_of(log), "'a.b_m' is not finite at sample 1");
    log.signals = {{"a.b_m", {0, 1}, {1}}};
    EXPECT_HAS(refusal_of(log), "has 2 times and 1 values");
    log.signals = {{"a.b_m", {}, {}}, {"a.b_m", {}, {}}};
    EXPECT_HAS(refusal_of(log), "stands twice");
    log.signals = {};
    log.header["bad\nkey"] = "x";
    EXPECT_HAS(refusal_of(log), "header line");
    EXPECT_NE(::access(path.c_str(), F_OK), 0);
    EXPECT_NE(::access((path + ".part").c_str(), F_OK), 0);
}

// The writer has a way of its own for millionths; what it writes is what std::to_chars would.
TEST(Write, every_number_stands_in_its_shortest_digits) {
    Signal signal{.name = "wheel0.current_A", .t_s = {}, .value = {}};
    std::vector<double> values = {0,
                                  -0.0,
                                  1e-3,
                                  0.001,
                                  -0.001,
                                  1e-4,
                                  0.00012,
                                  1.2e-5,
                                  100000,
                                  -100000,
                                  123456,
                                  1200000,
                                  1e5,
                                  1e6,
                                  999999,
                                  1e9,
                                  1e8,
                                  1e9 - 1,
                                  0.1,
                                  -0.3,
                                  1e-6,
                                  5e-324,
                                  1.5e308,
                                  0.000999,
                                  1e15,
                                  1e22,
                                  1.0 / 3,
                                  -2.0 / 3e6,
                                  4503599627370496.5,
                                  0.1 + 0.2,
                                  999999999.999999,
                                  1e-3 - 1e-9};
    for (int i = 1; i < 20000; ++i) values.push_back(i / 1e6), values.push_back(-i / 1e6); // with and without an exponent
    std::mt19937_64 random(7);
    for (int i = 0; i < 200000; ++i) {
        const double whole = static_cast<double>(static_cast<std::int64_t>(random() % 2000000000001ull) - 1000000000000ll);
        const double scale = std::pow(10.0, static_cast<double>(random() % 13));
        values.push_back(std::round(whole / scale) / 1e6);                    // millionths, of every size
        values.push_back(std::round(whole / scale) / 512);                    // a radar's clock
        values.push_back(whole / scale);                                      // and anything else
        values.push_back(std::nextafter(std::round(whole / scale) / 1e6, 9)); // beside them
    }
    for (const double value : values) signal.t_s.push_back(static_cast<double>(signal.t_s.size())), signal.value.push_back(value);
    Log log;
    log.signals.push_back(signal);
    const File file("numbers.csv", "");
    write_csv(log, file.path());
    std::ifstream in(file.path());
    std::string line;
    while (std::getline(in, line) && !line.starts_with("# format")) {
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_TRUE(std::getline(in, line));
        char want[64];
        char *end = std::to_chars(want, want + 32, static_cast<double>(i)).ptr;
        *end++ = ',';
        end = std::to_chars(end, want + sizeof want, values[i]).ptr;
        ASSERT_EQ(line, std::string(want, end));
    }
}

TEST(Write, to_a_folder_that_is_not_there_is_a_file_error) { EXPECT_THROW(write_csv(Log{}, "/nonexistent/x.csv"), FileError); }

TEST(Vocabulary, has_every_name_of_the_interchange_and_each_once) {
    for (const char *name : {"wheel3.speed_rad_s", "wheel0.encoder_count", "wheel12.current_A", "wheel0.duty", "wheel0.set_speed_rad_s",
                             "battery.voltage_V", "radar.adc_count", "radar.speed_m_s", "imu.accel_x_m_s2", "imu.gyro_z_rad_s",
                             "estimate.speed_m_s", "wheel0.slip", "camera.x_m", "camera.y_m", "camera.yaw_rad"}) {
        EXPECT_NE(find_quantity(name), nullptr) << name;
    }
    for (const char *name : {"wheel.speed_rad_s", "wheelx.duty", "wheel0.speed", "wheel0.duty_V", "speed_rad_s", "", ".", "wheel0."})
        EXPECT_EQ(find_quantity(name), nullptr) << name;
    for (const Quantity &entry : vocabulary()) {
        const std::string object(entry.object == "wheel<i>" ? "wheel0" : entry.object);
        EXPECT_EQ(find_quantity(object + "." + std::string(entry.quantity) + (entry.unit.empty() ? "" : "_") + std::string(entry.unit)),
                  &entry);
    }
    EXPECT_EQ(wheel_of("wheel12.duty"), 12);
    EXPECT_EQ(wheel_of("camera.x_m"), -1);
}
