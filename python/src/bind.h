// bind.h - what the parts of the extension share: the objects that Python holds, and how a long computation hears Ctrl-C.
#pragma once

#include "host_tools/lab/model/model.h"
#include "host_tools/log/read.h"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

namespace traction::python {

namespace nb = nanobind;

// A log as the reader left it: what was mended stays with it, so that the gate judges it as it judges the file.
struct LogData {
    log::Log log;
    std::vector<log::Repair> repairs;
};
using LogPointer = std::shared_ptr<const LogData>;

// Asks Python for pending signals, at most every 50 ms; throws nb::python_error (KeyboardInterrupt). Called without the GIL.
class Signals {
  public:
    void poll();

  private:
    double next_s_ = 0;
};

// Each part of the package, into the module.
void bind_errors(nb::module_ &m);
void bind_log(nb::module_ &m);
void bind_scenario(nb::module_ &m);
void bind_lab(nb::module_ &m);
void bind_loop(nb::module_ &m);

} // namespace traction::python
