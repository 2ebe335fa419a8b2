// rover_config.h - from what a rover is to what the firmware runs with: a pure builder, and the check of what cannot work.
//
// rover_parameters_t holds the primary numbers; control_config_build computes every derived one (reciprocals, per-tick gains,
// voltages per speed, the radar's template and window), so no number stands in two places. What a world really is stands elsewhere:
// sim/scenario/rover.h for the simulator, which may be given another description than the firmware (`simulate --believes`).
#ifndef TRACTION_FIRMWARE_CORE_ROVER_CONFIG_H
#define TRACTION_FIRMWARE_CORE_ROVER_CONFIG_H

#include "control.h"
#include "rover_parameters.h"

#ifdef __cplusplus
extern "C" {
#endif

// Total: any numbers give a config, but only one that control_config_check lets pass is fit to drive. Every SCALED number counts as it
// stands: call rover_parameters_scale first where some are not given. An unknown radar gets the reference's template.
void control_config_build(const rover_parameters_t *parameters, control_config_t *config);

typedef struct {
    const char *key;    // of ROVER_PARAMETER_LIST, or "radar"; 0: nothing to refuse
    const char *reason; // what cannot work and the mend, one line; static text
} control_refusal_t;

// The first of: a number that is not finite or outside its range; a radar or a rate that no linked template has; limits that cannot be
// reached, measured or kept. docs/rover_format.md lists the rules, rover_parameters_test breaks each.
control_refusal_t control_config_check(const rover_parameters_t *parameters, const control_config_t *config);

// The reference rover (table I, Lhomme-Desages) as this project drives it.
control_config_t rover_config_default(void);

// The paper's own estimator and gains over any rover's config, for its figures and for comparison.
void control_config_make_paper(control_config_t *config);

// The reference rover with them.
control_config_t rover_config_paper(void);

#ifdef __cplusplus
}
#endif

#endif
