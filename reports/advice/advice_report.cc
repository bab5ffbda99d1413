#include "reports/advice/advice_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "recording/collected.h"
#include "recording/counted.h"
#include "reports/text/answer_json.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Advice;
using evaluation::OptionAdvice;
using evaluation::PipelineAdvice;
using evaluation::Requirement;
using evaluation::RigOption;

std::string requirements_text(const Advice& advice) {
  const std::vector<std::string> texts = collected(advice.request.requirements, &Requirement::text);
  return fmt::format("{}", fmt::join(texts, " and "));
}

std::string asked_rig_text(const Advice& advice) {
  return fmt::format("{} at {:g} Hz",
                     counted(static_cast<std::uint64_t>(advice.request.rig.cameras), "camera"),
                     advice.request.rig.rate_hz);
}

// "100 % [95-100]".
std::string probability_text(const PipelineAdvice& pipeline) {
  const evaluation::Interval interval = pipeline.interval();
  return fmt::format("{} [{:.0f}-{:.0f}]", share_text(pipeline.share()), 100 * interval.low,
                     100 * interval.high);
}

std::string margin_text(double margin) {
  if (std::isnan(margin)) return "-";
  return std::isinf(margin) ? "all" : fmt::format("{:.2g}", margin);
}

std::string euro_text(double eur) { return fmt::format("{:.0f}", eur); }

std::string verdict(const OptionAdvice& option) {
  const PipelineAdvice& best = option.best();
  if (best.frames_dropped > 0) return "no: USB drops frames";
  if (best.is_fit()) return "yes";
  if (best.may_be_fit()) return "perhaps";
  return "no";
}

// The parts that the option has.
std::vector<const scenarios::Part*> parts_in(const RigOption& option) {
  std::vector<const scenarios::Part*> parts;
  if (option.camera.is_host) parts.push_back(&option.camera);
  for (const scenarios::Part* part :
       {&option.host, &option.usb_card, &option.network_switch, &option.clock}) {
    if (!part->part.empty()) parts.push_back(part);
  }
  return parts;
}

std::vector<std::string> part_names(const RigOption& option) {
  return collected(parts_in(option), &scenarios::Part::part);
}

Table options_table(const Advice& advice) {
  std::vector<Field<OptionAdvice>> fields = {
      {{"hosts"}, [](const auto& each) { return fmt::format("{}", each.option.hosts); }},
      {{"parts", Align::kLeft},
       [](const auto& each) {
         return fmt::format("{}", fmt::join(part_names(each.option), ", "));
       }},
      {{"price\nEUR"},
       [](const auto& each) {
         return fmt::format("{}-{}", euro_text(each.option.price.low_eur),
                            euro_text(each.option.price.high_eur));
       }},
      {{.header = "meets it", .align = Align::kLeft, .is_verdict = true}, verdict},
      {{"probability\n% [95 %]"}, [](const auto& each) { return probability_text(each.best()); }},
      {{"rigs"}, [](const auto& each) { return fmt::format("{}", each.best().seeds); }}};
  for (std::size_t i = 0; i < advice.request.requirements.size(); ++i) {
    const evaluation::Metric& metric = *advice.request.requirements[i].metric;
    fields.push_back(
        {{fmt::format("{}\nmedian", metric.title)}, [i, &metric](const OptionAdvice& each) {
           return metric_text(metric, each.best().median[i]);
         }});
  }
  fields.push_back({{"margin"}, [](const auto& each) { return margin_text(each.best().margin); }});
  fields.push_back({{"best pipeline", Align::kLeft}, [](const auto& each) {
                      const scenarios::Pipeline& best = each.best().pipeline;
                      return joined_stages(best, " + ");
                    }});
  return table_of(fields, advice.options, 2);
}

Block options_block(const Advice& advice) {
  return {.heading = "Rigs, the cheapest first",
          .table = options_table(advice),
          .prose = {
              "Probability: the share of simulated rigs (seeds) that meet all that is required, "
              "with its 95 % interval (Clopper-Pearson). Yes: at least 95 % of all rigs do; "
              "perhaps: of the few with which dearer rigs were tried. Margin: what is required "
              "divided by the 95 % quantile over the rigs, of shares the ratio of what is missing "
              "to 100 %. Best pipeline: the most usual one that meets it, else the nearest."}};
}

std::string part_line(const scenarios::Part& part) {
  std::vector<std::string> prices;
  for (const scenarios::PartPrice& price : part.prices) {
    prices.push_back(fmt::format("{:g}-{:g} EUR a {}", price.range.low_eur, price.range.high_eur,
                                 to_text(price.per)));
  }
  if (prices.empty()) prices = {"nothing"};
  return fmt::format("{}: {}; {} [{}]", part.part, part.name, fmt::join(prices, " and "),
                     part.price_source);
}

// " with /cameras/exposure_ms=1"
std::string changes_text(const Advice& advice) {
  std::vector<std::string> sets;
  for (const scenarios::Override& set : advice.request.rig.sets) {
    sets.push_back(fmt::format("{}={}", set.pointer, set.value));
  }
  return sets.empty() ? "" : fmt::format(" with {}", fmt::join(sets, ", "));
}

Block assumptions_block(const Advice& advice) {
  Block block{.heading = "What is assumed"};
  block.prose = {fmt::format(
      "The world is {}{}: physically nominal, fitted to no rig. Prices are rough classes of parts, "
      "without cameras, trigger, cables and work; availability, your cables and your building are "
      "not known. A host synchronisation that is installed badly is worse than here. Device times "
      "by polls need a program that reads the cameras' clocks; calibrated ones need the delays of "
      "the camera model, measured as a careful laboratory does.",
      advice.options.front().option.camera.world, changes_text(advice))};
  std::vector<std::string> seen;
  for (const OptionAdvice& each : advice.options) {
    const RigOption& option = each.option;
    for (const scenarios::Part* part : parts_in(option)) {
      if (std::ranges::count(seen, part->part) > 0) continue;
      seen.push_back(part->part);
      block.items.push_back(part_line(*part));
    }
  }
  return block;
}

std::string nothing_meets(const Advice& advice) {
  const OptionAdvice* nearest = &advice.options.front();
  for (const OptionAdvice& each : advice.options) {
    const PipelineAdvice& a = each.best();
    const PipelineAdvice& b = nearest->best();
    if (a.frames_dropped > 0) continue;
    if (a.share() > b.share() || (a.share() == b.share() && a.margin > b.margin)) nearest = &each;
  }
  const PipelineAdvice& best = nearest->best();
  if (best.may_be_fit()) {
    return fmt::format(
        "No rig is shown to meet {} for {} with 95 % probability. {} comes nearest, with {}: {} of "
        "{} simulated rigs do, a probability of {:.0f} to {:.0f} %; {} seeds that all do would "
        "show it (--seeds).",
        requirements_text(advice), asked_rig_text(advice), nearest->option.name(),
        best.pipeline.name, best.met, best.seeds, 100 * best.interval().low,
        100 * best.interval().high, evaluation::kAdviceSeeds);
  }
  return fmt::format(
      "None of {} meets {} for {} with 95 % probability. {} comes nearest, with {}: {} of {} "
      "simulated rigs do, at {}.",
      counted(advice.options.size(), "rig"), requirements_text(advice), asked_rig_text(advice),
      nearest->option.name(), best.pipeline.name, best.met, best.seeds,
      std::isnan(best.margin) ? "no margin, since a metric that is asked for has no value there"
                              : "a margin of " + margin_text(best.margin));
}

// What the tolerances of the task became; "" without any.
std::string need_text(const Advice& advice) {
  std::map<std::string, std::vector<std::string>> became;
  for (const Requirement& each : advice.request.requirements) {
    if (!each.tolerance.empty()) became[each.tolerance].push_back(each.text);
  }
  std::string sentences;
  for (const auto& [tolerance, texts] : became) {
    sentences += fmt::format("{}{} is taken as {}.", sentences.empty() ? "" : " ", tolerance,
                             fmt::join(texts, " and "));
  }
  return sentences;
}

Json pipeline_json(const PipelineAdvice& pipeline, const Advice& advice) {
  const evaluation::Interval interval = pipeline.interval();
  Json medians = Json::object();
  for (std::size_t i = 0; i < pipeline.median.size(); ++i) {
    medians[advice.request.requirements[i].metric->id] = pipeline.median[i];
  }
  return {{"pipeline", pipeline.pipeline.name},
          {"met", pipeline.met},
          {"seeds", pipeline.seeds},
          {"probability", pipeline.share()},
          {"low", interval.low},
          {"high", interval.high},
          {"margin", pipeline.margin},
          {"frames_dropped", pipeline.frames_dropped},
          {"medians", std::move(medians)}};
}

Json option_json(const OptionAdvice& each, const Advice& advice) {
  Json pipelines = Json::array();
  for (const PipelineAdvice& pipeline : each.pipelines) {
    pipelines.push_back(pipeline_json(pipeline, advice));
  }
  return {{"rig", each.option.name()},
          {"hosts", each.option.hosts},
          {"cameras_per_host", each.option.cameras_per_host},
          {"parts", part_names(each.option)},
          {"price_low_eur", each.option.price.low_eur},
          {"price_high_eur", each.option.price.high_eur},
          {"settled", each.is_settled},
          {"pipelines", std::move(pipelines)}};
}

}  // namespace

std::string price_class(const scenarios::PriceRange& price) {
  constexpr double kMiddleFromEur = 1000;
  constexpr double kHighFromEur = 10000;
  const double eur = price.middle_eur();
  return fmt::format("{} ({}-{} EUR)",
                     eur < kMiddleFromEur ? "low"
                     : eur < kHighFromEur ? "middle"
                                          : "high",
                     euro_text(price.low_eur), euro_text(price.high_eur));
}

AnswerText advice_answer(const Advice& advice) {
  if (!advice.recommended) {
    AnswerText answer{.lead = nothing_meets(advice)};
    answer.add("Need", need_text(advice));
    return answer;
  }
  const OptionAdvice& option = advice.options[*advice.recommended];
  const PipelineAdvice& best = option.best();
  AnswerText answer{.lead = fmt::format(
                        "{} meets {} for {} in {} of {} simulated rigs (a probability of {:.0f} to "
                        "{:.0f} %), with {}.",
                        option.option.name(), requirements_text(advice), asked_rig_text(advice),
                        best.met, best.seeds, 100 * best.interval().low, 100 * best.interval().high,
                        best.pipeline.name)};
  answer.add("Need", need_text(advice));
  answer.add("Price",
             fmt::format("It is the cheapest that does with 95 %: price class {}, without cameras "
                         "and trigger.",
                         price_class(option.option.price)));
  answer.add("Margin", fmt::format("{}: the limit over the 95 % quantile, the smallest of all "
                                   "requirements.",
                                   margin_text(best.margin)));
  if (advice.fails_first) {
    answer.add("Fails first",
               fmt::format("The stage {}, which makes {} of the {}.", advice.fails_first->stage,
                           share_text(advice.fails_first->share), advice.fails_first->metric));
  }
  return answer;
}

Document advice_document(const Advice& advice) {
  return {.title = fmt::format("{}: {}", asked_rig_text(advice), requirements_text(advice)),
          .head = paragraphs(advice_answer(advice)),
          .blocks = {options_block(advice), assumptions_block(advice)}};
}

Json advice_json(const Advice& advice) {
  Json root = new_document();
  root.update(
      {{"answer", answer_json(advice_answer(advice))},
       {"camera", advice.request.rig.camera},
       {"cameras", advice.request.rig.cameras},
       {"rate_hz", advice.request.rig.rate_hz},
       {"requirements", Json::array()},
       {"seeds",
        {{"first", advice.options_of_run.first_seed}, {"count", advice.options_of_run.seeds}}},
       {"recommended", nullptr},
       {"fails_first", nullptr},
       {"rare", nullptr},
       {"options", Json::array()}});
  for (const Requirement& each : advice.request.requirements) {
    root["requirements"].push_back(each.text);
  }
  root["sets"] = Json::array();
  for (const scenarios::Override& set : advice.request.rig.sets) {
    root["sets"].push_back({{"pointer", set.pointer}, {"value", set.value}});
  }
  root["tolerances"] = need_text(advice);
  if (advice.recommended) root["recommended"] = *advice.recommended;
  if (advice.fails_first) {
    root["fails_first"] = {{"metric", advice.fails_first->metric},
                           {"stage", advice.fails_first->stage},
                           {"share", advice.fails_first->share}};
  }
  for (const OptionAdvice& each : advice.options) {
    root["options"].push_back(option_json(each, advice));
  }
  return root;
}

}  // namespace simbench::reports
