/// What was identified, as an answer has it. What is not known is left out.
#include <cmath>

#include "query/identify/identification.hpp"

namespace sinew::inline v1 {
namespace {

void put_finite(Value& map, Value::Key key, double value) {
  if (std::isfinite(value)) map[key] = value;
}

Value errors_value(const MarkerErrors& errors) {
  Value value{{"rows", errors.rows}, {"failed", errors.failed}};
  if (errors.rows == 0) return value;
  put_finite(value, "rms", errors.rms);
  put_finite(value, "median", errors.median);
  put_finite(value, "max", errors.max);
  return value;
}

Value parameter_value(const FitParameter& parameter, const FittedParameter& fitted) {
  Value value{{"name", parameter.name}, {"unit", parameter.unit}};
  put_finite(value, "start", fitted.start);
  put_finite(value, "value", fitted.value);
  put_finite(value, "deviation", fitted.deviation);
  value["is_factor"] = parameter.is_factor;
  put_finite(value, "coordinate", fitted.coordinate);
  put_finite(value, "coordinate_deviation", fitted.coordinate_deviation);
  value["at_bound"] = fitted.at_bound;
  put_finite(value, "prior", parameter.prior);
  put_finite(value, "prior_share", fitted.prior_share);
  return value;
}

}  // namespace

void put_identification(const Identification& done, Value& answer) {
  const Identified& found = done.found;
  answer["iterations"] = found.report.iterations;
  answer["model"] = done.model;
  answer["fit"] = done.fit_names;
  answer["rows"] = done.rows.size();
  if (done.blocks > 0) answer["blocks"] = done.blocks;
  put_finite(answer, "noise", found.noise);
  if (done.is_mapped) {
    const TendonMap& map = done.agrees_best;
    answer["map"] = {{"sign", map.sign},           {"mirrored", map.mirrored}, {"turn", map.turn},
                     {"agreement", map.agreement}, {"next", map.next},         {"as_given", map.as_given}};
  }
  Value parameters = Value::list(), flat = Value::list();
  for (std::size_t p = 0; p < done.parameters.size(); ++p)
    parameters.push_back(parameter_value(done.parameters[p], found.parameters[p]));
  for (const FlatDirection& one : found.flat) {
    Value value = Value::map();
    put_finite(value, "deviation", one.deviation);
    value["along"] = combination(one, done.parameters);
    value["coefficients"] = one.coefficients;
    flat.push_back(std::move(value));
  }
  answer["parameters"] = std::move(parameters);
  answer["flat"] = std::move(flat);
  const auto size = static_cast<std::size_t>(found.covariance.rows());
  if (found.covariance.allFinite()) {
    std::vector<double> by_rows;
    for (Eigen::Index i = 0; i < found.covariance.rows(); ++i)
      for (Eigen::Index j = 0; j < found.covariance.cols(); ++j) by_rows.push_back(found.covariance(i, j));
    answer["covariance"] = Value(std::span<const double>(by_rows), size);
  }
  Value errors{{"before", errors_value(found.before)}, {"fitted", errors_value(found.train)}};
  if (done.held_out) errors["held_out"] = errors_value(done.held_out->errors);
  answer["errors"] = std::move(errors);
  if (done.held_out) answer["folds"] = done.folds;
}

}  // namespace sinew::inline v1
