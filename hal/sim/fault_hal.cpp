#include "fault_hal.h"

#include "forwarding.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traction::hal {

namespace {

constexpr double tick_s = 0.01;
static_assert(TICK_US == 10000);

constexpr std::uint32_t encoder_bit(unsigned wheel) { return std::uint32_t{FRAME_ENCODER_0} << wheel; }
constexpr std::uint32_t current_bit(unsigned wheel) { return std::uint32_t{FRAME_CURRENT_0} << wheel; }

// FRAME_* bits that a fault touches.
std::uint32_t bits_of(const sim::SensorFault &fault) {
    const auto per_wheel = [&](std::uint32_t first) {
        return fault.wheel < 0 ? first * 0xfu : first << static_cast<unsigned>(fault.wheel);
    };
    switch (fault.sensor) {
    case sim::FaultySensor::encoder:
        return per_wheel(FRAME_ENCODER_0);
    case sim::FaultySensor::current:
        return per_wheel(FRAME_CURRENT_0);
    case sim::FaultySensor::battery:
        return FRAME_BATTERY;
    case sim::FaultySensor::accel:
        return FRAME_ACCEL | FRAME_ACCEL_YZ;
    case sim::FaultySensor::gyro:
        return FRAME_GYRO | FRAME_GYRO_XY;
    case sim::FaultySensor::radar:
        return FRAME_RADAR;
    case sim::FaultySensor::bridge:
        return per_wheel(FRAME_BRIDGE_0);
    case sim::FaultySensor::emergency_stop:
        return FRAME_EMERGENCY_STOP;
    case sim::FaultySensor::camera:
        return 0;
    }
    return 0;
}

// Copies the fields of `bit` (one FRAME_* bit, radar excluded) from one frame to another, its presence too.
void copy_field(std::uint32_t bit, const sensor_frame_t &from, sensor_frame_t *to) {
    for (unsigned i = 0; i < WHEEL_COUNT; i++) {
        if (bit == encoder_bit(i)) to->encoder_count[i] = from.encoder_count[i];
        if (bit == current_bit(i)) to->current_count[i] = from.current_count[i];
    }
    if (bit == FRAME_BATTERY) to->battery_count = from.battery_count;
    if (bit == FRAME_ACCEL) to->accel_x_count = from.accel_x_count;
    if (bit == FRAME_ACCEL_YZ) {
        to->accel_y_count = from.accel_y_count;
        to->accel_z_count = from.accel_z_count;
    }
    if (bit == FRAME_GYRO) to->gyro_z_count = from.gyro_z_count;
    if (bit == FRAME_GYRO_XY) {
        to->gyro_x_count = from.gyro_x_count;
        to->gyro_y_count = from.gyro_y_count;
    }
    to->present = (to->present & ~bit) | (from.present & bit);
}

// What offset, drift and spike add at t_s.
double amount_now(const sim::SensorFault &fault, double t_s) {
    if (fault.kind == sim::FaultKind::drift) return fault.amount * (t_s - fault.from_s);
    if (fault.kind == sim::FaultKind::spike) return t_s < fault.from_s + tick_s - 1e-9 ? fault.amount : 0;
    return fault.kind == sim::FaultKind::offset ? fault.amount : 0;
}

bool silent(sim::FaultKind kind) { return kind == sim::FaultKind::dropped || kind == sim::FaultKind::timeout; }

} // namespace

FaultHal::FaultHal(const hal_t &inner, FaultScript script, const CountScale &scale, std::uint64_t seed)
    : inner_(inner), script_(std::move(script)), scale_(scale), random_(seed, "faults"), holding_(script_.sensors.size()),
      held_(script_.sensors.size()), missed_(script_.missed_ticks.size()), slipped_(script_.sensors.size()) {}

// `amount`, in the sensor's unit, added to the counts of `bit`; of a body's sensor to those of `axis` alone.
void FaultHal::add(std::uint32_t bit, int axis, double amount, sensor_frame_t *frame) {
    for (unsigned i = 0; i < WHEEL_COUNT; i++) {
        if (bit == encoder_bit(i)) // wraps as the encoder does
            frame->encoder_count[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(frame->encoder_count[i]) +
                                                                static_cast<std::uint32_t>(round_count(amount, INT32_MIN, INT32_MAX)));
        if (bit == current_bit(i))
            frame->current_count[i] =
                static_cast<std::uint16_t>(round_count(frame->current_count[i] + amount / scale_.current_A, 0, scale_.current_max));
    }
    if (bit == FRAME_BATTERY)
        frame->battery_count =
            static_cast<std::uint16_t>(round_count(frame->battery_count + amount / scale_.battery_V, 0, scale_.battery_max));
    const auto body = [&](std::int16_t &count, double unit) {
        count = static_cast<std::int16_t>(round_count(count + amount / unit, INT16_MIN, INT16_MAX));
    };
    if (bit == FRAME_ACCEL && axis == 0) body(frame->accel_x_count, scale_.accel_m_s2);
    if (bit == FRAME_ACCEL_YZ && axis != 0) body(axis == 1 ? frame->accel_y_count : frame->accel_z_count, scale_.accel_m_s2);
    if (bit == FRAME_GYRO_XY && axis != 2) body(axis == 0 ? frame->gyro_x_count : frame->gyro_y_count, scale_.gyro_rad_s);
    if (bit == FRAME_GYRO && axis == 2) body(frame->gyro_z_count, scale_.gyro_rad_s);
}

// What is left of a frame's samples is one run, as the frame has one number: the longer of what follows the last loss and what precedes
// the first.
void FaultHal::lose_samples(double share, sensor_frame_t *frame) {
    int first = -1, last = -1;
    for (int i = 0; i < frame->radar_samples; i++)
        if (random_.uniform() < share) {
            if (first < 0) first = i;
            last = i;
        }
    if (first < 0) return;
    const int after = frame->radar_samples - 1 - last, begin = after >= first ? last + 1 : 0, kept = std::max(first, after);
    std::copy_n(frame->radar_count + begin, kept, frame->radar_count);
    frame->radar_sequence += static_cast<std::uint32_t>(begin);
    frame->radar_samples = static_cast<std::uint8_t>(kept);
}

void FaultHal::add_noise(std::uint32_t bit, double amount, sensor_frame_t *frame) {
    const auto noisy = [&](double count, double unit, int low, int high) {
        return round_count(count + amount / unit * random_.normal(), low, high);
    };
    for (unsigned i = 0; i < WHEEL_COUNT; i++) {
        if (bit == encoder_bit(i)) frame->encoder_count[i] = noisy(frame->encoder_count[i], 1, INT32_MIN, INT32_MAX);
        if (bit == current_bit(i))
            frame->current_count[i] = static_cast<std::uint16_t>(noisy(frame->current_count[i], scale_.current_A, 0, scale_.current_max));
    }
    if (bit == FRAME_BATTERY)
        frame->battery_count = static_cast<std::uint16_t>(noisy(frame->battery_count, scale_.battery_V, 0, scale_.battery_max));
    const auto body = [&](std::int16_t &count, double unit) {
        count = static_cast<std::int16_t>(noisy(count, unit, INT16_MIN, INT16_MAX));
    };
    if (bit == FRAME_ACCEL) body(frame->accel_x_count, scale_.accel_m_s2);
    if (bit == FRAME_GYRO) body(frame->gyro_z_count, scale_.gyro_rad_s);
    if (bit == FRAME_ACCEL_YZ) {
        body(frame->accel_y_count, scale_.accel_m_s2);
        body(frame->accel_z_count, scale_.accel_m_s2);
    }
    if (bit == FRAME_GYRO_XY) {
        body(frame->gyro_x_count, scale_.gyro_rad_s);
        body(frame->gyro_y_count, scale_.gyro_rad_s);
    }
}

void FaultHal::apply_radar(std::size_t index, const sim::SensorFault &fault, sensor_frame_t *frame) {
    sensor_frame_t &held = held_[index];
    if (silent(fault.kind)) {
        frame->present &= ~static_cast<std::uint32_t>(FRAME_RADAR);
        frame->radar_samples = 0;
    } else if (fault.kind == sim::FaultKind::stuck) {
        if (!holding_[index]) held = *frame;
        holding_[index] = true;
        std::fill_n(frame->radar_count, frame->radar_samples, held.radar_count[0]);
    } else if (fault.kind == sim::FaultKind::noisy) {
        for (int i = 0; i < frame->radar_samples; i++) {
            const double count = frame->radar_count[i] + fault.amount * random_.normal();
            frame->radar_count[i] = static_cast<std::uint16_t>(round_count(count, 0, sim::Radar::count_max));
        }
    } else if (fault.kind == sim::FaultKind::dead) {
        for (int i = 0; i < frame->radar_samples; i++)
            frame->radar_count[i] =
                static_cast<std::uint16_t>(round_count(512 + fault.amount * random_.normal(), 0, sim::Radar::count_max));
    } else if (fault.kind == sim::FaultKind::lost) {
        lose_samples(fault.amount, frame);
    } else if (fault.kind == sim::FaultKind::offset || fault.kind == sim::FaultKind::drift || fault.kind == sim::FaultKind::spike) {
        const double add = amount_now(fault, t_s_);
        for (int i = 0; i < frame->radar_samples; i++)
            frame->radar_count[i] = static_cast<std::uint16_t>(round_count(frame->radar_count[i] + add, 0, sim::Radar::count_max));
    } else {
        // the stream as a whole comes late, so a frame keeps its number of samples
        const auto late = static_cast<std::size_t>(fault.amount * scale_.radar_rate_Hz + 0.5);
        const std::size_t samples = frame->radar_samples;
        for (std::size_t i = 0; i < samples; i++) {
            const std::size_t back = late + samples - i; // from the end of past_radar_
            frame->radar_count[i] = past_radar_[past_radar_.size() > back ? past_radar_.size() - back : 0];
        }
    }
}

void FaultHal::apply(std::size_t index, const sim::SensorFault &fault, sensor_frame_t *frame) {
    const std::uint32_t bits = bits_of(fault);
    if ((bits & FRAME_RADAR) != 0u) {
        apply_radar(index, fault, frame);
        return;
    }
    if (fault.kind == sim::FaultKind::stuck && !holding_[index]) {
        held_[index] = *frame;
        holding_[index] = true;
    }
    const auto late = static_cast<std::size_t>(fault.amount / tick_s + 0.5);
    for (std::uint32_t bit = 1; bit <= bits; bit <<= 1u) {
        if ((bits & bit) == 0u) continue;
        if (silent(fault.kind)) frame->present &= ~bit;
        if (fault.kind == sim::FaultKind::stuck) copy_field(bit, held_[index], frame);
        if (fault.kind == sim::FaultKind::noisy) add_noise(bit, fault.amount, frame);
        if (const double more = amount_now(fault, t_s_); more != 0) add(bit, fault.axis, more, frame);
        for (unsigned i = 0; fault.kind == sim::FaultKind::slipping && i < WHEEL_COUNT && past_.size() > 1; i++) {
            if (bit != encoder_bit(i)) continue;
            const auto turned = static_cast<std::int32_t>(static_cast<std::uint32_t>(past_.back().encoder_count[i]) -
                                                          static_cast<std::uint32_t>(past_[past_.size() - 2].encoder_count[i]));
            slipped_[index][i] += fault.amount * turned;
            add(bit, fault.axis, -slipped_[index][i], frame);
        }
        if (fault.kind == sim::FaultKind::delayed) copy_field(bit, past_[past_.size() > late ? past_.size() - 1 - late : 0], frame);
    }
}

// The next tick, and, where the script says so, those after it that nobody reads.
hal_result_t FaultHal::wait_tick() {
    hal_result_t result = inner_.wait_tick(inner_.context);
    waited_++;
    for (std::size_t i = 0; i < script_.missed_ticks.size(); i++) {
        const sim::MissedTicks &missed = script_.missed_ticks[i];
        const double due_s = missed.from_s + missed.every_s * static_cast<double>(missed_[i]);
        const bool due = static_cast<double>(waited_) * tick_s >= due_s && due_s < missed.to_s && (missed.every_s > 0 || missed_[i] == 0);
        if (!due) continue;
        missed_[i]++;
        for (std::uint32_t n = 0; n < missed.ticks && result == HAL_OK; n++, waited_++) result = inner_.wait_tick(inner_.context);
    }
    return result;
}

hal_t FaultHal::hal() {
    hal_t wrapped = forwarding(this);
    if (!script_.missed_ticks.empty()) wrapped.wait_tick = [](void *context) { return static_cast<FaultHal *>(context)->wait_tick(); };
    wrapped.read = [](void *context, sensor_frame_t *frame) {
        auto *self = static_cast<FaultHal *>(context);
        hal_result_t result = self->inner_.read(self->inner_.context, frame);
        if (result < 0 && result != HAL_ERR_TIMEOUT) return result;
        if (self->script_.sensors.empty() && self->script_.emergency_stop_s.empty()) return result;
        self->t_s_ = (frame->tick + 1.0) * tick_s;
        self->past_.push_back(*frame);
        if (self->past_.size() > memory_ticks) self->past_.pop_front();
        for (int i = 0; i < frame->radar_samples; i++) self->past_radar_.push_back(frame->radar_count[i]);
        while (self->past_radar_.size() > memory_ticks * RADAR_SAMPLES_PER_TICK_MAX) self->past_radar_.pop_front();
        const double t_s = (frame->tick + 1.0) * tick_s;
        for (std::size_t i = 0; i < self->script_.sensors.size(); i++) {
            const sim::SensorFault &fault = self->script_.sensors[i];
            if (t_s < fault.from_s || t_s >= fault.to_s) continue;
            self->apply(i, fault, frame);
            if (fault.kind == sim::FaultKind::timeout && bits_of(fault) != 0) result = HAL_ERR_TIMEOUT;
        }
        for (const auto &[from_s, to_s] : self->script_.emergency_stop_s)
            if (t_s >= from_s && t_s < to_s) frame->emergency_stop = true;
        return result;
    };
    return wrapped;
}

} // namespace traction::hal
