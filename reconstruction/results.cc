#include "reconstruction/results.h"

#include "evaluation/statistics/statistics.h"

namespace simbench::reconstruction {
namespace {

template <class Value>
evaluation::Series series_of(const std::vector<SeedReprojection>& seeds, const Value& value) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SeedReprojection& seed : seeds) values.push_back(value(seed));
  return evaluation::make_series(std::move(values));
}

evaluation::Series errors_of(const std::vector<SeedReprojection>& seeds,
                             double ErrorSummary::*member) {
  return series_of(seeds, [member](const SeedReprojection& seed) { return seed.errors.*member; });
}

}  // namespace

evaluation::Series ReprojectionRow::mean_cm() const {
  return errors_of(seeds, &ErrorSummary::mean_cm);
}
evaluation::Series ReprojectionRow::std_cm() const {
  return errors_of(seeds, &ErrorSummary::std_cm);
}
evaluation::Series ReprojectionRow::median_cm() const {
  return errors_of(seeds, &ErrorSummary::median_cm);
}
evaluation::Series ReprojectionRow::p95_cm() const {
  return errors_of(seeds, &ErrorSummary::p95_cm);
}
evaluation::Series ReprojectionRow::desync_ms() const {
  return series_of(seeds, [](const SeedReprojection& seed) { return seed.desync_ms; });
}

}  // namespace simbench::reconstruction
