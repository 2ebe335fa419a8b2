#include "tests/bench/scatterers.h"

#include <algorithm>
#include <cmath>

namespace outdoors {

namespace {

constexpr double pi = clutter::pi, cell_m = 0.01, column_m = 0.25, height_m = 0.3, side_m = 1.0, near_m = -0.3, far_m = 2.2;
constexpr double per_wave = 2 * 9.9e9 / 299792458.0; // turns of phase a metre of r

// cos(2 pi t) to 2e-6; plain enough for the compiler to make four at a time
double cos_turns(double t) {
    constexpr double magic = 6755399441055744.0; // 1.5 * 2^52: adding it rounds to whole numbers
    const double u = t - ((t + magic) - magic), y = 39.47841760435743 * u * u;
    return 1 + y * (-0.5 + y * (1.0 / 24 + y * (-1.0 / 720 + y * (1.0 / 40320 + y * (-1.0 / 3628800 + y * (1.0 / 479001600))))));
}

clutter::Biquad low_pass(double corner_Hz, double rate_Hz, double q) {
    const double k = std::tan(pi * corner_Hz / rate_Hz), norm = 1 / (1 + k / q + k * k);
    clutter::Biquad out;
    out.b = {k * k * norm, 2 * k * k * norm, k * k * norm};
    out.a = {2 * (k * k - 1) * norm, (1 - k / q + k * k) * norm};
    return out;
}

} // namespace

Scatterers::Scatterers(std::uint64_t seed, double depression_deg)
    : seed_(seed), cosine_(std::cos(depression_deg * pi / 180)), sine_(std::sin(depression_deg * pi / 180)) {
    double power = 0;
    constexpr int places = 1000; // over 5 m
    for (int i = 0; i < places; ++i) {
        const double value = exact(40 + 0.00523 * i, 0);
        power += value * value / places;
    }
    scale_ = 1 / std::sqrt(power);
}

const std::vector<Scatterers::Point> &Scatterers::column(int index) {
    auto found = columns_.find(index);
    if (found == columns_.end()) {
        clutter::Random random{seed_ * 0x51ed2701u + static_cast<std::uint64_t>(index + 1000000) * 0x2545f491u};
        std::vector<Point> points;
        const int count = static_cast<int>(40 * column_m * 2 * side_m + 0.5);
        for (int i = 0; i < count; ++i) {
            points.push_back({column_m * (index + random.uniform()), side_m * (2 * random.uniform() - 1), 0.01 * (2 * random.uniform() - 1),
                              std::exp(0.6 * random.normal()), random.uniform()});
        }
        found = columns_.emplace(index, std::move(points)).first;
    }
    return found->second;
}

double Scatterers::gain(const Point &point, double x_m) const {
    const double x = point.x - x_m, down = height_m - point.z, r2 = x * x + point.y * point.y + down * down, r = std::sqrt(r2);
    const double c = cosine_, s = sine_, ahead = (x * c + down * s) / r;
    if (x <= 0 && ahead <= 0) {
        return 0;
    }
    const double up = (x * s - down * c) / r, across = point.y / r;
    // one-way power cos^n is the two-way amplitude: half at 18 and 36 deg
    const double el = std::sqrt(std::max(0.0, 1 - up * up)), az = std::sqrt(std::max(0.0, 1 - across * across));
    const double lobe = ahead <= 0 ? 0.1 : std::max(0.003, std::pow(el, 13.8) * std::pow(az, 3.27));
    return point.amplitude * lobe * std::sqrt(down / r) / r2;
}

void Scatterers::look_at(int cell) {
    cell_ = cell;
    x_.clear(), y2_.clear(), z_.clear(), turns_.clear(), near_.clear(), far_.clear();
    const double x = cell * cell_m;
    for (int k = static_cast<int>(std::floor((x + near_m) / column_m)); k <= static_cast<int>(std::floor((x + far_m) / column_m)); ++k) {
        for (const Point &point : column(k)) {
            const double here = gain(point, x), there = gain(point, x + cell_m);
            if (here + there < 0.003) {
                continue;
            }
            x_.push_back(point.x), y2_.push_back(point.y * point.y), z_.push_back(height_m - point.z), turns_.push_back(point.turns);
            near_.push_back(here), far_.push_back(there);
        }
    }
}

constexpr int per_cell = 8; // samples of 1.25 mm: 12 in a turn

const float *Scatterers::samples(int cell) {
    std::vector<float> &of = sampled_[cell];
    if (of.empty()) {
        for (int i = 0; i < per_cell; ++i) {
            of.push_back(static_cast<float>(exact(cell_m * (cell + (i + 1e-9) / per_cell), 0)));
        }
    }
    return of.data();
}

double Scatterers::echo(double x_m, double z_m) {
    if (z_m != 0) {
        return exact(x_m, z_m);
    }
    const double at = x_m / cell_m * per_cell;
    const int first = static_cast<int>(std::floor(at)) - 1;
    double e[4];
    for (int i = 0; i < 4; ++i) {
        const int cell = static_cast<int>(std::floor(static_cast<double>(first + i) / per_cell));
        e[i] = static_cast<double>(samples(cell)[first + i - cell * per_cell]);
    }
    const double u = at - (first + 1);
    return e[1] + 0.5 * u * (e[2] - e[0] + u * (2 * e[0] - 5 * e[1] + 4 * e[2] - e[3] + u * (3 * (e[1] - e[2]) + e[3] - e[0])));
}

double Scatterers::exact(double x_m, double z_m) {
    const int cell = static_cast<int>(std::floor(x_m / cell_m));
    if (cell != cell_) {
        look_at(cell);
    }
    const double along = x_m / cell_m - cell;
    double sum = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
        const double x = x_[i] - x_m, z = z_[i] + z_m, r = std::sqrt(x * x + y2_[i] + z * z);
        sum += (near_[i] + along * (far_[i] - near_[i])) * cos_turns(per_wave * r + turns_[i]);
    }
    return scale_ * sum;
}

FrontEnd::FrontEnd(double echo_count, double snr_dB, std::uint64_t seed)
    : noise_{seed * 7717 + 11}, echo_count_(echo_count), low_{low_pass(80, 512, 0.5412), low_pass(80, 512, 1.3066)} {
    const double white = echo_count * std::pow(10, -snr_dB / 20);
    after_ = white * std::sqrt(0.5);
    before_ = white * std::sqrt(0.5 * 77 / 256); // as much in the band as the white half has there
    for (double &step : step_) {
        step = 0.3 * (2 * noise_.uniform() - 1);
    }
}

double FrontEnd::filtered(double echo) {
    constexpr double rate = 512, high_Hz = 1.93; // two of them: -3 dB at 3 Hz
    const double poles[4] = {0.2, 2, 20, 200};   // [Hz] a decade apart: 1/f between them, four variances alike
    double pink = 0;
    for (int i = 0; i < 4; ++i) {
        const double keep = std::exp(-2 * pi * poles[i] / rate);
        pink_[i] = keep * pink_[i] + std::sqrt(1 - keep * keep) * noise_.normal();
        pink += pink_[i] * std::sqrt(0.5); // two decades and a half of them are in the band
    }
    t_ += 1 / rate;
    double value = echo_count_ * echo + before_ * pink;
    const double keep = std::exp(-2 * pi * high_Hz / rate);
    for (int i = 0; i < 2; ++i) {
        const double in = value;
        high_[i] = keep * (high_[i] + in - high_in_[i]);
        high_in_[i] = in;
        value = high_[i];
    }
    const double hum = 0.02 * echo_count_ * (std::sin(2 * pi * 50.03 * t_) + 0.3 * std::sin(2 * pi * 150.09 * t_ + 1));
    return low_[1].step(low_[0].step(value)) + hum + after_ * noise_.normal();
}

int FrontEnd::convert(double count) const {
    const int code = static_cast<int>(std::clamp(std::floor(count + 0.5), 0.0, 1023.0));
    return std::clamp(static_cast<int>(std::floor(count + 0.5 + step_[static_cast<std::size_t>(code)])), 0, 1023);
}

Rattle::Rattle(std::uint64_t seed) : random_{seed * 4201 + 77} {
    for (double &value : tolerance_) {
        value = 1 + 0.01 * random_.normal();
    }
}

double Rattle::accel(double true_m_s2, double bias, double noise, double rim_turns_s) {
    const double keep = std::exp(-0.01 / 0.012);
    coloured_ = keep * coloured_ + std::sqrt(1 - keep * keep) * random_.normal();
    walk_ += 0.0005 * random_.normal(); // 5 mm/s^2 per root of a second
    shake_ += 12 * rim_turns_s * 0.01;  // turns of the lugs
    shake2_ += 0.01 * 7.3 * rim_turns_s;
    const double shaken = rim_turns_s == 0 ? 0 : 0.06 * std::sin(2 * pi * shake_) + 0.03 * std::sin(2 * pi * shake2_);
    return 0.99 * true_m_s2 + bias + walk_ + noise * std::sqrt(0.5) * (coloured_ + random_.normal()) + shaken;
}

void Rattle::turn(double rad_s, double dt, bool free) {
    for (std::size_t i = 0; i < angle_.size(); ++i) {
        const double own = free ? slip_[i] + 0.005 * std::sin(turned_[i]) : 0;
        turned_[i] += rad_s * dt;
        angle_[i] += rad_s * dt * tolerance_[free ? i : 0] * (1 + own); // a closed loop has one wheel for all four
    }
}

void Rattle::waver() {
    for (double &slip : slip_) {
        slip += -slip * 0.01 / 0.4 + 0.02 * std::sqrt(2 * 0.01 / 0.4) * random_.normal();
    }
}

} // namespace outdoors
