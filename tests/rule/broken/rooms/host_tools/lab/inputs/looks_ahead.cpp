// A tree that breaks the rule: the inputs know the model that they are to be judged by.
#include "host_tools/lab/forward/forward.h"
