#include "reports/stability/verdict_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Judgement;
using evaluation::LimitVerdict;
using evaluation::MaskVerdict;

constexpr const char* kJudgementIds[] = {"passes", "fails", "cannot_tell"};
constexpr const char* kBandIds[] = {"all", "low", "high"};

// "MTIE is 42.4 ns at tau 32 s, allowed 33.8 ns".
std::string measured_text(const LimitVerdict& limit) {
  const bool is_time = evaluation::facts_of(limit.limit.quantity).is_time();
  const auto text = [&](double value) { return is_time ? time_text(value) : number_text(value); };
  std::string sentence = fmt::format("{} is {}", limit.limit.label, text(*limit.value));
  if (limit.tau_s) sentence += fmt::format(" at tau {:.6g} s", *limit.tau_s);
  sentence += fmt::format(", allowed {}", text(limit.allowed));
  if (limit.share_within) {
    sentence += fmt::format(" ({} of the points within)", share_text(*limit.share_within));
  }
  return sentence;
}

// The limit that decides: the first that fails; else the one with the value nearest to its limit.
const LimitVerdict* decisive(const MaskVerdict& verdict) {
  const LimitVerdict* found = nullptr;
  for (const LimitVerdict& limit : verdict.limits) {
    if (!limit.value) continue;
    if (limit.judgement == Judgement::kFails) return &limit;
    const auto share = [](const LimitVerdict& of) { return *of.value / of.allowed; };
    if (found == nullptr || share(limit) > share(*found)) found = &limit;
  }
  return found;
}

std::string untold_text(const MaskVerdict& verdict) {
  std::string text;
  for (const LimitVerdict& limit : verdict.limits) {
    if (limit.judgement != Judgement::kCannotTell) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", limit.limit.label, limit.reason);
  }
  return text;
}

}  // namespace

std::string mask_verdict_text(const MaskVerdict& verdict) {
  const LimitVerdict* const limit = decisive(verdict);
  switch (verdict.judgement) {
    case Judgement::kFails:
      return fmt::format("{}: fails: {}.", verdict.title, measured_text(*limit));
    case Judgement::kPasses:
      return fmt::format("{}: passes; nearest: {}.", verdict.title, measured_text(*limit));
    case Judgement::kCannotTell:
      break;
  }
  return fmt::format(
      "{}: cannot be judged as a whole: {}.{}", verdict.title, untold_text(verdict),
      limit == nullptr ? ""
                       : " Within it where it was judged; nearest: " + measured_text(*limit) + ".");
}

Json mask_verdict_json(const MaskVerdict& verdict) {
  Json object = {{"mask", verdict.mask},
                 {"title", verdict.title},
                 {"judgement", kJudgementIds[static_cast<std::size_t>(verdict.judgement)]},
                 {"limits", Json::array()}};
  for (const LimitVerdict& limit : verdict.limits) {
    Json each = {{"label", limit.limit.label},
                 {"quantity", evaluation::facts_of(limit.limit.quantity).id},
                 {"band", kBandIds[static_cast<std::size_t>(limit.limit.band)]},
                 {"judgement", kJudgementIds[static_cast<std::size_t>(limit.judgement)]},
                 {"tau_s", nullptr},
                 {"value", nullptr},
                 {"allowed", nullptr},
                 {"share_within", nullptr},
                 {"reason", nullptr}};
    if (limit.tau_s) each["tau_s"] = *limit.tau_s;
    if (limit.value) {
      each["value"] = *limit.value;
      each["allowed"] = limit.allowed;
    }
    if (limit.share_within) each["share_within"] = *limit.share_within;
    if (!limit.reason.empty()) each["reason"] = limit.reason;
    object["limits"].push_back(std::move(each));
  }
  return object;
}

}  // namespace simbench::reports
