// Certificates (evaluation/certificates) as text, Markdown, LaTeX or JSON: first a sentence that
// answers, then a row for each pipeline, what ties the widest pairs, contradictions with the facts
// that prove them, and what was assumed.
//
// JSON: {"schema_version", "version", "commit", "answer" (reports/text/answer_json.h), "scenario",
// "seeds": {"first", "count"}, "horizon": "whole" | "causal", "within_ms", "assumptions": {name:
// value}, "rows": [{"pipeline", "problem": text or null, "captures", "sets", "due_pulses",
// "certified_ms": {"p50", "p95", "max"}, "within", "within_share", "messages",
// "unusable_messages", "estimated_exchanges", "polls", "pulses", "unused_pulses",
// "logged_outside", "frames", "truth_outside", "impossible_sets", "lone_frames", "weakest":
// [{"tie": "camera" | "hosts", "first", "second", "sets", "width_ms", "age_s", "drift_share"}],
// "contradicted": [{"seed", "before_ms", "chain": [text], "possible_ppm"}]}]}; "sets" have two
// frames or more; what is unknown or does not exist is null, "frames" and "truth_outside" too where
// no truth is known, or nothing bounds it.
#pragma once

#include "evaluation/run/certificate_run.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

AnswerText certificate_answer(const evaluation::CertificateRun& run);
Document certificate_document(const evaluation::CertificateRun& run);
Json certificate_json(const evaluation::CertificateRun& run);

// The pairs of frames that were kept (CertificateOptions::keep_pairs), a line each, for who wants
// each interval: the second frame was exposed least_ms to most_ms after the first, for sure; empty
// where nothing bounds it, and truth_ms where nobody knows it.
//
//   pipeline,seed,set,first_camera,first_sensor_us,second_camera,second_sensor_us,least_ms,most_ms,
//   truth_ms
//
// Lines of a changed world end with what was changed (LineEnds).
std::string pairs_csv(const evaluation::CertificateRun& run);

}  // namespace simbench::reports
