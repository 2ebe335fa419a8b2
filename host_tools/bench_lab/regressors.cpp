#include "regressors.h"

#include "host_tools/lab/decision/columns.h"
#include "host_tools/log/write_file.h"

#include <nlohmann/json.hpp>

namespace traction::bench_lab {

namespace {

using nlohmann::json;

// Columns as they come, the description beside them.
class Table {
  public:
    void add(json description, const Eigen::VectorXd &values) {
        list_.push_back(std::move(description));
        put(values);
    }
    void put(const Eigen::VectorXd &values) {
        for (const double value : values) numbers_.push_back(static_cast<float>(value));
    }
    void write(const json &head, const std::string &file) const {
        json all = head;
        all["columns"] = list_;
        log::WholeFile out(file);
        out.write(all.dump() + '\n');
        out.write({reinterpret_cast<const char *>(numbers_.data()), numbers_.size() * sizeof(float)});
        out.keep();
    }

  private:
    json list_ = json::array();
    std::vector<float> numbers_;
};

} // namespace

void write_regressors(const lab::Model &model, const lab::Dataset &data, const std::string &file) {
    const lab::Physics physics = lab::make_physics(model);
    lab::Problem problem(data, physics, lab::free_parameters(model, physics));
    problem.fit({});
    Table table;
    Eigen::VectorXd time(problem.residual.size()), block(problem.residual.size());
    json balances = json::array();
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < data.balance.size(); ++b) {
        balances.push_back(data.balance[b].name);
        for (std::size_t r = 0; r < data.balance[b].measured.size(); ++r, ++row)
            time[row] = 0.5 * (data.balance[b].t0_s[r] + data.balance[b].t1_s[r]), block[row] = static_cast<double>(b);
    }
    table.put(time);
    table.put(block);
    table.put(problem.residual.cwiseProduct(problem.row_scale));
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        const lab::FreeParameter &p = problem.parameters[i];
        table.add({{"own", p.owner + "." + p.key},
                   {"wheel", p.wheel},
                   {"prior", p.prior},
                   {"increment", problem.theta[static_cast<Eigen::Index>(i)]}},
                  problem.jacobian.col(static_cast<Eigen::Index>(i)));
    }
    lab::Columns::Cache cache;
    lab::Columns columns(problem, cache);
    for (const lab::Candidate &c : lab::catalogue_candidates(model, data, problem.forward().motion())) {
        const Eigen::MatrixXd values = columns.of(c);
        json shape = json::object();
        for (const auto &[key, value] : c.variant) shape[key] = value;
        for (std::size_t j = 0; j < c.strengths.size(); ++j)
            table.add({{"effect", c.effect},
                       {"wheel", c.wheel},
                       {"shape", shape},
                       {"strength", c.strengths[j].key},
                       {"of_interest", c.of_interest[j]},
                       {"minimum", c.minimum[j]},
                       {"maximum", c.maximum[j]}},
                      values.col(static_cast<Eigen::Index>(j)));
    }
    table.write({{"schema", "traction.regressors/1"}, {"rows", row}, {"balances", balances}}, file);
}

} // namespace traction::bench_lab
