#include "make_dataset.h"

#include "smoothing_bias.h"

namespace traction::lab {

Dataset make_dataset(const Model &model, const log::Log &log, const log::Log *repeat) {
    Dataset data = measured_data(model, log);
    add_smoothing_bias(model, data);
    if (repeat != nullptr) noise_from_repeat(data, measured_data(model, *repeat));
    return data;
}

} // namespace traction::lab
