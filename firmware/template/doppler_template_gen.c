// doppler_template_gen - writes a radar's template (radar_template.h) as a C table for the firmware, at build time, on the build machine.
#include "radar_template.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *name;
    const char *title;
    double carrier_Hz, vertical_deg, horizontal_deg;
} radar_t;

// Table II, Lhomme-Desages
static const radar_t radars[] = {
    {"mdu1130", "MDU1130, 9.9 GHz, 36 x 72 deg", 9.9e9, 36, 72},
    {"dj_radar_2", "DJ Radar II, 24.13 GHz, 15 deg", 24.13e9, 15, 15},
    {"dj_radar_3", "DJ Radar III, 24.13 GHz, 20 x 16 deg", 24.13e9, 20, 16},
    {"drs1000", "DRS1000, 35.5 GHz, 12 deg", 35.5e9, 12, 12},
};

static void write_whole(FILE *out, const char *field, const int32_t *value, int32_t count)
{
    fprintf(out, "    .%s = {", field);
    for (int32_t i = 0; i < count; i++) {
        fprintf(out, "%d, ", (int)value[i]);
    }
    fprintf(out, "},\n");
}

static void write_template(const radar_t *radar, const radar_geometry_t *geometry, const char *name, const doppler_template_t *t, FILE *out)
{
    double mean = 0, mode = 0, width = 0;
    radar_template_describe(geometry, &mean, &mode, &width);
    fprintf(out,
            "// Made by doppler_template_gen from the radar's geometry; do not edit.\n"
            "// %s, %.0f deg below horizontal, ground exponent %.0f. Mean shift over that of the axis: %.3f, mode %.3f;\n"
            "// standard deviation over mean: %.3f.\n",
            radar->title, geometry->depression_deg, geometry->ground_exponent, mean, mode, width);
    fprintf(out,
            "#include \"firmware/core/doppler_template.h\"\n\nconst doppler_template_t doppler_template_%s = {\n    .log_step = %.8ef,\n"
            "    .paper_m_s_per_Hz = %.8ef,\n    .sample_rate_Hz = %.8ef,\n    .speeds = %d,\n    .first_bin = %d,\n    .bins = %d,\n"
            "    .spread = %.8ef,\n    .deaf = %.8ef,\n    .line = %d,\n    .from_peak = %d,\n    .speed_m_s = {",
            name, (double)t->log_step, (double)t->paper_m_s_per_Hz, (double)t->sample_rate_Hz, (int)t->speeds, (int)t->first_bin,
            (int)t->bins, (double)t->spread, (double)t->deaf, t->line, t->from_peak);
    for (int32_t i = 0; i < t->speeds; i++) {
        fprintf(out, "%.8ef, ", (double)t->speed_m_s[i]);
    }
    fprintf(out, "},\n    .inverse = {\n");
    for (int32_t i = 0; i < t->speeds; i++) {
        for (int32_t k = 0; k < t->bins; k++) {
            fprintf(out, "%d,", t->inverse[i * t->bins + k]);
        }
        fprintf(out, "\n");
    }
    fprintf(out, "},\n");
    write_whole(out, "volume", t->volume, t->speeds);
    write_whole(out, "quiet", t->quiet, t->speeds);
    fprintf(out, "    .exact = %d,\n    .start = {", (int)t->exact);
    for (int32_t k = 0; k < t->bins; k++) {
        fprintf(out, "%d, ", t->start[k]);
    }
    fprintf(out, "},\n    .window = {.ticks = %d, .tau_s = %.8ef, .tau_ticks = %.8ef, .per_s = %.8ef, .weight_q15 = {",
            (int)t->window.ticks, (double)t->window.tau_s, (double)t->window.tau_ticks, (double)t->window.per_s);
    for (int32_t j = 0; j < t->window.ticks; j++) {
        fprintf(out, "%d, ", t->window.weight_q15[j]);
    }
    fprintf(out, "}},\n};\n");
}

static int run(const radar_t *radar, const char *path, double rate_Hz, const char *name)
{
    static doppler_template_t made;
    const radar_geometry_t geometry = radar_geometry_like_reference(radar->carrier_Hz, radar->vertical_deg, radar->horizontal_deg, rate_Hz);
    const radar_geometry_refusal_t refusal = radar_geometry_check(&geometry);
    if (refusal.field != NULL) {
        fprintf(stderr, "doppler_template_gen: %s = %g: give %g to %g: %s\n", refusal.field, refusal.value, refusal.low, refusal.high,
                refusal.mend);
        return 2;
    }
    radar_template_make(&geometry, &made);
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        fprintf(stderr, "doppler_template_gen: cannot write %s\n", path);
        return 4;
    }
    write_template(radar, &geometry, name, &made, out);
    const bool bad = ferror(out) != 0;
    return fclose(out) != 0 || bad ? 4 : 0;
}

int main(int argc, char **argv)
{
    for (size_t i = 0; (argc == 3 || argc == 5) && i < sizeof radars / sizeof *radars; i++) {
        if (strcmp(argv[1], radars[i].name) == 0) { // the same radar behind a converter of another rate, under another name
            return run(&radars[i], argv[2], argc == 5 ? atof(argv[3]) : 512, argc == 5 ? argv[4] : radars[i].name);
        }
    }
    fprintf(stderr, "usage: doppler_template_gen mdu1130|dj_radar_2|dj_radar_3|drs1000 OUT.c [RATE_HZ NAME]\n");
    return 2;
}
