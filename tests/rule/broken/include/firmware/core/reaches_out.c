// Breaks the include rule on purpose: the core may not know the HAL.
#include "hal/hal.h"
