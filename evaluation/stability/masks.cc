#include "evaluation/stability/masks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "algorithms/ports/assert.h"
#include "recording/duration_in.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr double kNs = 1e-6;  // in ms
constexpr double kFirstTauS = 0.1;
constexpr double kLastTauOfPrtcS = 10'000;
constexpr double kSpanOfClassesS = 1000;

MaskLimit size_limit(std::string label, LimitedQuantity quantity, double ns) {
  return {.label = std::move(label), .quantity = quantity, .segments = {{.base = ns * kNs}}};
}

// One over tau: its segments in nanoseconds.
MaskLimit curve_limit(std::string label, LimitedQuantity quantity,
                      std::vector<MaskSegment> segments_ns) {
  for (MaskSegment& segment : segments_ns) {
    segment.base *= kNs;
    segment.factor *= kNs;
  }
  return {.label = std::move(label), .quantity = quantity, .segments = std::move(segments_ns)};
}

ClockMask prtc(const char* id, const char* title, double max_te_ns, double mtie_bend_s,
               std::vector<MaskSegment> tdev_ns) {
  return {.id = id,
          .title = title,
          .limits = {size_limit("max|TE|", LimitedQuantity::kMaxTe, max_te_ns),
                     curve_limit("MTIE", LimitedQuantity::kMtie,
                                 {{kFirstTauS, mtie_bend_s, 25, 0.275, 1},
                                  {mtie_bend_s, kLastTauOfPrtcS, max_te_ns}}),
                     curve_limit("TDEV", LimitedQuantity::kTdev, std::move(tdev_ns))}};
}

struct ClassNs {
  double max_te;
  double cte;
  double mtie;
  double tdev;
  double high;
};

MaskLimit in_band(MaskLimit limit, Band band) {
  limit.band = band;
  return limit;
}

ClockMask boundary_class(const char* id, const char* title, const ClassNs& ns) {
  ClockMask mask{
      .id = id,
      .title = title,
      .limits = {
          size_limit("max|TE|", LimitedQuantity::kMaxTe, ns.max_te),
          size_limit("cTE", LimitedQuantity::kConstantTe, ns.cte),
          in_band(
              curve_limit("dTE_L MTIE", LimitedQuantity::kMtie, {{1, kSpanOfClassesS, ns.mtie}}),
              Band::kLow),
          in_band(
              curve_limit("dTE_L TDEV", LimitedQuantity::kTdev, {{1, kSpanOfClassesS, ns.tdev}}),
              Band::kLow),
          in_band(size_limit("dTE_H p-p", LimitedQuantity::kPeakToPeak, ns.high), Band::kHigh)}};
  for (MaskLimit& limit : mask.limits) limit.least_s = kSpanOfClassesS;
  return mask;
}

std::vector<ClockMask> made_masks() {
  std::vector<ClockMask> all;
  all.push_back(prtc("prtc_a", "ITU-T G.8272 PRTC-A", 100, 273,
                     {{kFirstTauS, 100, 3}, {100, 1000, 0, 0.03, 1}, {1000, kLastTauOfPrtcS, 30}}));
  all.push_back(prtc("prtc_b", "ITU-T G.8272 PRTC-B", 40, 54.5,
                     {{kFirstTauS, 100, 1}, {100, 500, 0, 0.01, 1}, {500, kLastTauOfPrtcS, 5}}));
  all.push_back(boundary_class("class_a", "ITU-T G.8273.2 class A", {100, 50, 40, 4, 70}));
  all.push_back(boundary_class("class_b", "ITU-T G.8273.2 class B", {70, 20, 40, 4, 70}));
  all.push_back(boundary_class("class_c", "ITU-T G.8273.2 class C", {30, 10, 10, 2, 30}));
  ClockMask& class_d = all.emplace_back(ClockMask{
      .id = "class_d",
      .title = "ITU-T G.8273.2 class D",
      .limits = {in_band(size_limit("max|TE_L|", LimitedQuantity::kMaxTe, 5), Band::kLow)}});
  class_d.limits.front().least_s = kSpanOfClassesS;
  all.push_back(
      {.id = "sec",
       .title = "ITU-T G.813 option 1",
       .limits = {
           curve_limit("MTIE", LimitedQuantity::kMtie,
                       {{kFirstTauS, 1, 40}, {1, 100, 0, 40, 0.1}, {100, 1000, 0, 25.25, 0.2}}),
           curve_limit("TDEV", LimitedQuantity::kTdev,
                       {{kFirstTauS, 25, 3.2}, {25, 100, 0, 0.64, 0.5}, {100, 1000, 6.4}})}});
  return all;
}

// In the order of LimitedQuantity.
constexpr QuantityFacts kQuantities[] = {
    {"max_te_ms", "max_te", "max|TE|", &TimeErrorSummary::max_te_ms, {}},
    {"constant_te_ms", "cte", "cTE", &TimeErrorSummary::constant_te_ms, {}},
    {"dynamic_te_p2p_ms", "te_p2p", "TE p-p", &TimeErrorSummary::dynamic_te_p2p_ms, {}},
    {"p50_te_ms", "p50", "|TE| of 50 %", &TimeErrorSummary::p50_te_ms, {}},
    {"p95_te_ms", "p95", "|TE| of 95 %", &TimeErrorSummary::p95_te_ms, {}},
    {"p99_te_ms", "p99", "|TE| of 99 %", &TimeErrorSummary::p99_te_ms, {}},
    {"p99_9_te_ms", "p99.9", "|TE| of 99.9 %", &TimeErrorSummary::p99_9_te_ms, {}},
    {"adev", "adev", "ADEV", nullptr, Deviation::kAdev},
    {"mdev", "mdev", "MDEV", nullptr, Deviation::kMdev},
    {"hdev", "hdev", "HDEV", nullptr, Deviation::kHdev},
    {"tdev_ms", "tdev", "TDEV", nullptr, Deviation::kTdev},
    {"mtie_ms", "mtie", "MTIE", nullptr, Deviation::kMtie}};

// What a limit of one's own may be.
std::string option_names() {
  std::string names;
  for (const QuantityFacts& quantity : kQuantities) {
    const char* const tau = quantity.has_tau() ? "@TAU" : "";
    names += fmt::format("{}{}{}", names.empty() ? "" : ", ", quantity.option, tau);
  }
  return names;
}

// One of the limits that --limit states.
struct LimitText {
  std::string_view text;

  [[noreturn]] void refuse(std::string_view what, std::string_view found,
                           const std::string& allowed) const {
    throw scenarios::InputError(fmt::format("--limit {}: {}: found {}, allowed: {}",
                                            printable_name(text), what, quoted_bytes(found),
                                            allowed));
  }
  double seconds(std::string_view what, std::string_view found, const char* example) const {
    const std::optional<double> value = seconds_in(found);
    if (value && *value <= kLargestSeconds) return *value;
    refuse(what, found, fmt::format("{}, as in {}", kDurationAllowed, example));
  }
  double number(std::string_view found) const {
    const auto value = number_in<double>(found);
    if (value && *value > 0 && std::isfinite(*value)) return *value;
    refuse("value", found, "a number above 0, as in 1e-9");
  }
};

MaskLimit own_limit(std::string_view text) {
  const LimitText limit{text};
  const std::size_t equals = text.find('=');
  const std::string_view before = text.substr(0, equals);
  const std::size_t at = before.find('@');
  const std::string_view name = before.substr(0, at);
  const auto known = std::ranges::find(kQuantities, name, &QuantityFacts::option);
  if (known == std::end(kQuantities)) limit.refuse("name", name, option_names());
  if (equals == std::string::npos) limit.refuse("limit", text, fmt::format("{}=VALUE", text));
  if (known->has_tau() != (at != std::string_view::npos)) {
    limit.refuse(
        "limit", before,
        known->has_tau() ? fmt::format("{}@TAU, as in {}@10s", name, name) : std::string(name));
  }
  MaskSegment segment;
  if (known->has_tau()) {
    segment.from_s = segment.to_s = limit.seconds("tau", before.substr(at + 1), "10s");
  }
  const std::string_view value = text.substr(equals + 1);
  segment.base =
      known->is_time() ? 1e3 * limit.seconds("value", value, "100ns") : limit.number(value);
  return {.label = known->label,
          .quantity = static_cast<LimitedQuantity>(known - std::begin(kQuantities)),
          .segments = {segment}};
}

}  // namespace

bool QuantityFacts::is_time() const { return std::string_view(id).ends_with("_ms"); }

const QuantityFacts& facts_of(LimitedQuantity quantity) {
  return kQuantities[static_cast<std::size_t>(quantity)];
}

double limit_at(const MaskLimit& limit, double tau_s) {
  SIMBENCH_ASSERT(!limit.segments.empty(), "a limit has a segment");
  const auto segment = std::find_if(limit.segments.begin(), limit.segments.end() - 1,
                                    [&](const MaskSegment& each) { return tau_s <= each.to_s; });
  return segment->base + segment->factor * std::pow(tau_s, segment->exponent);
}

std::span<const ClockMask> masks() {
  static const std::vector<ClockMask> all = made_masks();
  return all;
}

const ClockMask& mask_named(const std::string& id) {
  std::string allowed;
  for (const ClockMask& mask : masks()) {
    if (mask.id == id) return mask;
    allowed += (allowed.empty() ? "" : ", ") + mask.id;
  }
  throw scenarios::InputError(fmt::format("--mask: found '{}', allowed: {}", id, allowed));
}

ClockMask limits_mask(const std::vector<std::string>& limits) {
  SIMBENCH_ASSERT(!limits.empty(), "a mask has a limit");
  ClockMask mask{.id = "limit", .title = "--limit"};
  for (const std::string& text : limits) mask.limits.push_back(own_limit(text));
  return mask;
}

}  // namespace simbench::evaluation
