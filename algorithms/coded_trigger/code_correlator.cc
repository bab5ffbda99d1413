#include "algorithms/coded_trigger/code_correlator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// A likelihood further below the best counts as this far: nothing beside it.
constexpr double kNothingNats = 60;

}  // namespace

CodeCorrelator::CodeCorrelator(const TriggerCode& code, const CodeNoise& noise)
    : code_(code), noise_(noise), loss_nats_(-std::log(noise.lost_share)) {
  SIMBENCH_ASSERT(noise.noise_us > 0 && noise.rate_error_ppm > 0, "no clock is exact");
  SIMBENCH_ASSERT(noise.lost_share > 0 && noise.lost_share < 1, "some frames are lost");
  const double rate_us = noise.rate_error_ppm * 1e-6 * to_ns(code.period()) * 1e-3;
  prior_ = noise.noise_us * noise.noise_us / (rate_us * rate_us);
  const auto length = static_cast<std::size_t>(code.length());
  shifts_us_.reserve(length);
  for (const std::int32_t shift_ns : code.shifts_ns()) shifts_us_.push_back(shift_ns * 1e-3);
  even_square_ = shifts_us_.front() * shifts_us_.front();
  for (const double shift_us : shifts_us_) {
    if (shift_us * shift_us != even_square_) even_square_ = -1;
    if (even_square_ < 0) break;
  }
  for (auto* const sums : {&sum_s_, &sum_ts_, &sum_ys_, &costs_}) sums->resize(length);
  if (even_square_ < 0) sum_ss_.resize(length);
  if (code.leaves_out()) nats_.resize(length);
}

void CodeCorrelator::clear() {
  for (auto* const sums : {&sum_s_, &sum_ts_, &sum_ys_, &sum_ss_, &nats_}) {
    std::ranges::fill(*sums, 0.0);
  }
  points_ = 0;
  sum_t_ = sum_tt_ = sum_y_ = sum_ty_ = sum_yy_ = 0;
}

// add(place of slot 0, place of this slot), in two runs of which each is without a wrap.
template <class Add>
void CodeCorrelator::at_each_place(std::int64_t slot, const Add& add) {
  const std::size_t length = shifts_us_.size();
  const std::size_t first = code_.place(slot);
  const std::size_t wrap = length - first;
  for (std::size_t j = 0; j < wrap; ++j) add(j, first + j);
  for (std::size_t j = wrap; j < length; ++j) add(j, j - wrap);
}

void CodeCorrelator::count(std::int64_t slot, double residual_us, int sign) {
  const double one = sign;
  const double t = one * static_cast<double>(slot);
  const double y = one * residual_us;
  points_ += static_cast<std::size_t>(sign);
  sum_t_ += t;
  sum_tt_ += t * static_cast<double>(slot);
  sum_y_ += y;
  sum_ty_ += t * residual_us;
  sum_yy_ += y * residual_us;
  at_each_place(slot, [&](std::size_t j, std::size_t place) {
    const double shift_us = shifts_us_[place];
    sum_s_[j] += one * shift_us;
    sum_ts_[j] += t * shift_us;
    sum_ys_[j] += y * shift_us;
  });
  if (!sum_ss_.empty()) {
    at_each_place(slot, [&](std::size_t j, std::size_t place) {
      sum_ss_[j] += one * shifts_us_[place] * shifts_us_[place];
    });
  }
  if (!nats_.empty()) {
    at_each_place(slot, [&](std::size_t j, std::size_t place) {
      if (code_.sent()[place] == 0) nats_[j] += one * kImpossible;
    });
  }
}

void CodeCorrelator::count_absent(std::int64_t slot, int sign) {
  if (nats_.empty()) return;
  at_each_place(slot, [&](std::size_t j, std::size_t place) {
    if (code_.sent()[place] != 0) nats_[j] += sign * loss_nats_;
  });
}

// RSS, of the least squares with the prior of the rate.
double CodeCorrelator::squares_at(std::size_t place) const {
  const auto n = static_cast<double>(points_);
  const double spread = sum_tt_ + prior_;
  const double determinant = n * spread - sum_t_ * sum_t_;
  const double r = sum_y_ - sum_s_[place];
  const double tr = sum_ty_ - sum_ts_[place];
  const double ss = sum_ss_.empty() ? n * even_square_ : sum_ss_[place];
  const double rr = sum_yy_ - 2 * sum_ys_[place] + ss;
  const double explained = (spread * r * r - 2 * sum_t_ * r * tr + n * tr * tr) / determinant;
  return std::max(0.0, rr - explained);
}

double CodeCorrelator::nats_behind(const CodeVerdict& verdict, std::size_t place,
                                   double noise_us) const {
  const double squares = squares_at(place) - squares_at(verdict.place);
  const double nats = nats_.empty() ? 0 : nats_[place] - nats_[verdict.place];
  return squares / (2 * noise_us * noise_us) + nats;
}

CodeVerdict CodeCorrelator::judge() {
  SIMBENCH_ASSERT(points_ >= 3, "a line through two points leaves no noise");
  const double stated = noise_.noise_us * noise_.noise_us;
  const auto cost = [this](std::size_t place, double squares, double variance) {
    return squares / (2 * variance) + (nats_.empty() ? 0 : nats_[place]);
  };
  CodeVerdict verdict;
  for (std::size_t place = 0; place < costs_.size(); ++place) {
    costs_[place] = squares_at(place);
    if (cost(place, costs_[place], stated) < cost(verdict.place, costs_[verdict.place], stated)) {
      verdict.place = place;
    }
  }
  const double left = costs_[verdict.place] / static_cast<double>(points_ - 2);
  const double variance = std::max(stated, left);
  verdict.noise_us = std::sqrt(variance);
  const double best = cost(verdict.place, costs_[verdict.place], variance);
  const double nothing = std::exp(-kNothingNats);
  double others = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t place = 0; place < costs_.size(); ++place) {
    if (place == verdict.place) continue;
    least = std::min(least, costs_[place]);
    const double behind = cost(place, costs_[place], variance) - best;
    others += behind < kNothingNats ? std::exp(-behind) : nothing;
  }
  verdict.squares_behind = least - costs_[verdict.place];
  verdict.error_probability = others / (1 + others);
  const auto n = static_cast<double>(points_);
  const double spread = sum_tt_ + prior_;
  const double determinant = n * spread - sum_t_ * sum_t_;
  const double r = sum_y_ - sum_s_[verdict.place];
  const double tr = sum_ty_ - sum_ts_[verdict.place];
  verdict.level_us = (spread * r - sum_t_ * tr) / determinant;
  verdict.rate_us = (n * tr - sum_t_ * r) / determinant;
  return verdict;
}

}  // namespace simbench
