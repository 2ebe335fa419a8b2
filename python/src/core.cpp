#include "bind.h"

NB_MODULE(_core, m) {
    m.doc() = "The compiled half of the package: no promise is made of its names; use `traction`.";
    traction::python::bind_errors(m);
    traction::python::bind_log(m);
    traction::python::bind_scenario(m);
    traction::python::bind_lab(m);
    traction::python::bind_loop(m);
}
