// A tree that breaks the rule: a room knows who opens it.
#include "host_tools/lab/model/model.h"
#include "host_tools/lab/session.h"
