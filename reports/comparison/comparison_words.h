// Comparisons in plain words.
#ifndef SIMBENCH_REPORTS_COMPARISON_COMPARISON_WORDS_H_
#define SIMBENCH_REPORTS_COMPARISON_COMPARISON_WORDS_H_

#include <string>

#include "evaluation/scoring/metrics.h"
#include "evaluation/statistics/paired.h"

namespace simbench::reports {

// "better", "too_few_seeds", ...: for programs.
const char* verdict_name(evaluation::Verdict verdict);

// "better"; "worse, by less than 5 %"; "no difference seen: all equal"; "too few seeds: 240
// needed".
std::string verdict_text(const evaluation::PairedComparison& comparison, double smallest_effect);

// A metric's value as it is shown: milliseconds as they are, shares in percent.
double shown_value(const evaluation::Metric& metric, double value);
// "AMD ms", "recall %".
std::string shown_title(const evaluation::Metric& metric);

// Three digits, whatever the size: "0.00528", "1.45", "201", "1234"; "-" for NaN.
std::string factor_text(double factor);

// What B is against A: "AMD 205 times smaller [181, 230]", "RMDV 12 % larger [8 %, 15 %]",
// "recall 100 % in place of 0 %", "absolute error: no difference seen".
std::string effect_words(const evaluation::Metric& metric,
                         const evaluation::PairedComparison& comparison, double smallest_effect);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_COMPARISON_WORDS_H_
