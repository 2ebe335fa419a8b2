// What the libraries throw becomes the exception of traction._errors that has its parts: file, line, key, value, mend.
#include "bind.h"

#include "host_tools/lab/gate.h"
#include "host_tools/report/report.h"
#include "sim/scenario/scenario_error.h"

#include <nanobind/stl/string.h>

#include <chrono>
#include <exception>
#include <filesystem>

namespace traction::python {

void Signals::poll() {
    const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (now_s < next_s_) return;
    next_s_ = now_s + 0.05;
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

namespace {

struct Parts {
    const char *type;
    std::string message, file = {};
    std::size_t line = 0, column = 0;
    std::string key = {}, value = {}, mend = {};
};

void set_error(const Parts &parts) {
    const nb::object type = nb::module_::import_("traction._errors").attr(parts.type);
    const nb::object error = type(parts.message, parts.file, parts.line, parts.column, parts.key, parts.value, parts.mend);
    PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(const std::exception_ptr &thrown, void *) {
    try {
        std::rethrow_exception(thrown);
    } catch (const sim::ScenarioError &e) {
        set_error(
            {.type = "ScenarioError", .message = e.what(), .file = e.file, .line = e.line, .key = e.key, .value = e.value, .mend = e.mend});
    } catch (const lab::ModelError &e) {
        set_error({.type = "ModelError", .message = e.what(), .file = e.file, .line = e.line, .key = e.key, .mend = e.mend});
    } catch (const log::FileError &e) {
        set_error({.type = "FileError", .message = e.what(), .file = e.file, .line = e.line, .mend = e.mend});
    } catch (const log::LogError &e) {
        set_error({.type = "LogError", .message = e.what(), .file = e.file, .line = e.line, .column = e.column, .mend = e.mend});
    } catch (const lab::Refused &e) {
        set_error({.type = "Refused", .message = e.what()});
    } catch (const report::ReportError &e) {
        set_error({.type = "InputError", .message = e.what()});
    } catch (const std::filesystem::filesystem_error &e) {
        set_error(
            {.type = "FileError", .message = e.path1().string() + ": cannot be read: " + e.code().message(), .file = e.path1().string()});
    }
}

} // namespace

void bind_errors(nb::module_ &) { nb::register_exception_translator(translate); }

} // namespace traction::python
