#include "reports/results/sets_block.h"

#include "reports/text/number_text.h"

namespace simbench::reports {

TextTable sets_block(const std::vector<const evaluation::Row*>& rows) {
  TextTable block({{"pipeline", Align::kLeft},
                   {"gathering", Align::kLeft},
                   {"complete\nsets"},
                   {"sets:\nprecision"},
                   {"sets:\nrecall"},
                   {"index\nerrors"},
                   {"partial\nsets"},
                   {"frames\ndiscarded"},
                   {"AMD of\nsets ms"},
                   {"abs. error\nof sets ms"},
                   {"emitted after\nmean ms"},
                   {"emitted after\nlargest ms"}});
  for (const evaluation::Row* each : rows) {
    const evaluation::Row& row = *each;
    block.add({row.pipeline, row.gathering, count_text(row.sets.emitted), share_text(row.precision),
               share_text(row.recall), row.verified() ? count_text(row.sets.index_errors) : "-",
               count_text(row.sets.partial), count_text(row.sets.discarded_frames),
               number_text(row.set_amd_ms.median), number_text(row.set_absolute_error_ms.median),
               number_text(row.emission_latency_ms.median),
               number_text(row.emission_latency_max_ms)});
  }
  return block;
}

}  // namespace simbench::reports
