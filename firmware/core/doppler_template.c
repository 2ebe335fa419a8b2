#include "doppler_template.h"

const doppler_template_t doppler_template_mdu1130 = {
    .speed_min_m_s = 0.04f,
    .paper_m_s_per_Hz = 0.016113f, // c/(2 f0 cos 20 deg), (11)
    .sample_rate_Hz = 512.0f,
    .first_bin = 1,
    .bins = 45,
};
