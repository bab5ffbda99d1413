// A clock log that is a table: a column of times, one of time errors (or of fractional frequencies,
// which are summed up), the units of both. The contract is that of
// evaluation/stability/clock_log.h.
//
//   TableReader table(LineReader("errors.csv"));
//   if (is_table_of_values(table)) ClockLog log = read_table_log(table, {.unit = kNanosecondUnit});
#pragma once

#include <vector>

#include "evaluation/stability/clock_log.h"
#include "recording/table.h"

namespace simbench::evaluation {

// Whether its first rows have numbers or times. Before the first next().
bool is_table_of_values(const TableReader& table);
// Its columns of values, each of which may be the series.
std::vector<ClockLogSeries> table_columns(const TableReader& table);
// Reads all rows. Throws scenarios::InputError, LineError.
ClockLog read_table_log(TableReader& table, const ClockLogOptions& options);

}  // namespace simbench::evaluation
