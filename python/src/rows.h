// Rows of equal layout that Python sees as an array, in the memory where they are.
//
// Python reads them through NumPy's array interface; the array keeps them alive. simbench/tables.py
// makes a NumPy array of the bytes and the fields.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace simbench::python {

struct RowField {
  std::string name;
  std::string format;  // as NumPy writes it: "<f8"
  std::size_t offset = 0;
};

class Rows {
 public:
  template <class Row>
  Rows(std::vector<Row> rows, std::vector<RowField> fields, std::size_t row_bytes = sizeof(Row))
      : fields_(std::move(fields)), row_bytes_(row_bytes) {
    const auto owner = std::make_shared<std::vector<Row>>(std::move(rows));
    data_ = owner->data();
    bytes_ = owner->size() * sizeof(Row);
    owner_ = owner;
  }

  const std::vector<RowField>& fields() const { return fields_; }
  std::size_t row_bytes() const { return row_bytes_; }
  const void* data() const { return data_; }
  std::size_t bytes() const { return bytes_; }

 private:
  std::vector<RowField> fields_;
  std::size_t row_bytes_;
  std::shared_ptr<const void> owner_;
  const void* data_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace simbench::python
