// A clock log that is a table: a column of times, one of time errors (or of fractional frequencies,
// which are summed up), the units of both. The contract is that of
// evaluation/stability/clock_log.h.
//
// A table with columns that are called pipeline, seed, host, source or clock has a series for each
// of their values, as `simbench clocks --output` writes it.
//
//   TableReader rows(LineReader("errors.csv"));
//   LogSeriesSet series({.unit = kNanosecondUnit});
//   if (is_table_of_values(rows)) use(read_table_log(rows, {.unit = kNanosecondUnit}, series));
#pragma once

#include <vector>

#include "evaluation/stability/clock_log.h"
#include "evaluation/stability/log_series.h"
#include "recording/table.h"

namespace simbench::evaluation {

// Whether its first rows have numbers or times. Before the first next().
bool is_table_of_values(const TableReader& table);
// Its columns of values, each of which may be the series; before the first next().
std::vector<ClockLogSeries> table_columns(const TableReader& table);
// Whether it has columns that tell series apart.
bool has_series_columns(const TableReader& table);
// Reads all rows. If a table has several series, the log has notes alone, and `series` the points.
// Throws scenarios::InputError, LineError.
ClockLog read_table_log(TableReader& table, const ClockLogOptions& options, LogSeriesSet& series);

}  // namespace simbench::evaluation
