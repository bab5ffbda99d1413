#include "reports/text/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace simbench::reports {

std::string number_text(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < 1e-4 || size >= 1e9) return fmt::format("{:.2e}", value);
  const double rounded = std::stod(fmt::format("{:.2e}", size));
  const int exponent = static_cast<int>(std::floor(std::log10(rounded)));
  return fmt::format("{:.{}f}", value, std::max(0, 2 - exponent));
}

std::string decimals_text(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string share_text(double share) {
  if (!std::isfinite(share)) return "-";
  if (share == 0) return "0 %";
  if (share == 1) return "100 %";
  const std::string text = fmt::format("{:.1f}", share * 100);
  if (text == "100.0") return "> 99.9 %";
  if (text == "0.0") return "< 0.1 %";
  return text + " %";
}

std::string percentile_text(const evaluation::Percentile& percentile) {
  if (!std::isfinite(percentile.percent)) return "-";
  return fmt::format("{:.0f} % [{:.0f}-{:.0f}]", percentile.percent, percentile.low,
                     percentile.high);
}

std::string placement_text(const evaluation::Percentile& percentile) {
  switch (evaluation::placement_of(percentile)) {
    case evaluation::Placement::kInside:
      return "inside";
    case evaluation::Placement::kOutside:
      return "outside";
    case evaluation::Placement::kTooFewSeeds:
      return "too few seeds";
  }
  return "";
}

std::string placement_legend() {
  return fmt::format(
      "inside: the whole interval of its percentile lies from 5 to 95 %; outside: all of it lies "
      "beyond; too few seeds: neither (outside takes {} seeds).",
      evaluation::kFewestOutside);
}

std::string count_text(std::int64_t count) {
  const std::string digits = std::to_string(count);
  const std::size_t sign = count < 0 ? 1 : 0;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > sign && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

std::string short_text(double value) {
  if (!std::isfinite(value)) return "-";
  struct Prefix {
    double factor;
    const char* symbol;
  };
  constexpr std::array<Prefix, 3> kPrefixes = {{{1e9, " G"}, {1e6, " M"}, {1e3, " k"}}};
  for (const Prefix& prefix : kPrefixes) {
    if (value >= 0.9995 * prefix.factor)  // which three digits round up
      return fmt::format("{:.3g}{}", value / prefix.factor, prefix.symbol);
  }
  return fmt::format("{:.3g}", value);
}

std::string counted_seeds(std::uint64_t first, std::uint64_t count) {
  const std::string seeds = counted(count, "seed");
  return count == 1 ? fmt::format("{} ({})", seeds, first)
                    : fmt::format("{} ({}-{})", seeds, first, first + count - 1);
}

void ScoredSeeds::add(std::size_t seeds) {
  if (seeds == 0) return;
  fewest = most == 0 ? seeds : std::min(fewest, seeds);
  most = std::max(most, seeds);
}

std::string scored_seeds_text(const ScoredSeeds& seeds) {
  if (seeds.fewest == seeds.most) return fmt::format("{} of {}", seeds.most, seeds.all);
  return fmt::format("{}-{} of {}", seeds.fewest, seeds.most, seeds.all);
}

std::string capitalised(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return text;
}

}  // namespace simbench::reports
