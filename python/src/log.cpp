// Logs: columns as NumPy arrays over the library's own memory.
#include "bind.h"

#include "host_tools/check/report_json.h"
#include "host_tools/lab/gate.h"
#include "host_tools/log/vocabulary.h"

#include <memory>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <map>
#include <optional>
#include <tuple>

namespace traction::python {

namespace {

using Column = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;
using Given = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// A view: the array keeps `log` alive, and cannot be written to.
Column view(const std::vector<double> &values, const nb::handle &log) { return Column(values.data(), {values.size()}, log); }

const log::Signal &signal_at(const LogData &data, std::size_t i) { return data.log.signals.at(i); }

std::shared_ptr<LogData> read(const std::string &path, const std::string &map) {
    const nb::gil_scoped_release free;
    auto data = std::make_shared<LogData>();
    data->log = log::read_csv(path, map, data->repairs);
    return data;
}

std::shared_ptr<LogData> of_columns(const std::vector<std::tuple<std::string, Given, Given>> &columns,
                                    const std::map<std::string, std::string> &header, const std::string &name) {
    std::vector<log::Signal> signals;
    for (const auto &[column, t_s, value] : columns)
        signals.push_back({column, {t_s.data(), t_s.data() + t_s.size()}, {value.data(), value.data() + value.size()}});
    const nb::gil_scoped_release free;
    auto data = std::make_shared<LogData>();
    data->log = log::log_of_columns(std::move(signals), header, name, data->repairs);
    return data;
}

check::Machine machine(const std::optional<lab::Model> &model) { return model ? lab::machine_of(*model) : check::Machine{}; }

std::string check_log(const LogData &data, const std::optional<lab::Model> &model, const std::string &name, const std::string &model_name) {
    const nb::gil_scoped_release free;
    return check::report_json(check::check(data.log, data.repairs, machine(model)), name, "", model_name).dump();
}

std::string check_file(const std::string &path, const std::string &map, const std::optional<lab::Model> &model,
                       const std::string &model_name) {
    const nb::gil_scoped_release free;
    return check::report_json(check::check_file(path, map, machine(model)), path, map, model_name).dump();
}

} // namespace

void bind_log(nb::module_ &m) {
    nb::class_<LogData>(m, "LogData")
        .def_static("read", &read, nb::arg("path"), nb::arg("map"))
        .def_static("of_columns", &of_columns, nb::arg("columns"), nb::arg("header"), nb::arg("name"))
        .def_prop_ro("names",
                     [](const LogData &self) {
                         std::vector<std::string> names;
                         for (const log::Signal &s : self.log.signals) names.push_back(s.name);
                         return names;
                     })
        .def("times", [](nb::handle self, std::size_t i) { return view(signal_at(nb::cast<const LogData &>(self), i).t_s, self); })
        .def("values", [](nb::handle self, std::size_t i) { return view(signal_at(nb::cast<const LogData &>(self), i).value, self); })
        .def_prop_ro("header", [](const LogData &self) { return self.log.header; })
        .def_prop_ro("repairs", [](const LogData &self) { return self.log.repairs; })
        .def_prop_ro("source", [](const LogData &self) { return self.log.source; })
        .def_prop_ro("duration_s", [](const LogData &self) { return self.log.duration_s(); })
        .def("write", [](const LogData &self, const std::string &path) {
            const nb::gil_scoped_release free;
            log::write_csv(self.log, path);
        });
    m.def("check_log", &check_log, nb::arg("log"), nb::arg("model").none(), nb::arg("name"), nb::arg("model_name"));
    m.def("check_file", &check_file, nb::arg("path"), nb::arg("map"), nb::arg("model").none(), nb::arg("model_name"));
    // unit, meaning and kind of a column's name; None outside the vocabulary
    m.def("quantity", [](const std::string &name) -> std::optional<std::tuple<std::string, std::string, std::string>> {
        const log::Quantity *q = log::find_quantity(name);
        if (q == nullptr) return std::nullopt;
        return std::tuple{std::string(q->unit), std::string(q->meaning), std::string(log::kind_name(q->kind))};
    });
}

} // namespace traction::python
