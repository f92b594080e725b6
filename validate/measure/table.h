// Reference data: CSV with a head of # lines that name the source, then the columns' names, then
// rows.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dreampm::validate {

class Table {
 public:
  /// `name` is for messages. Throws InputError for a row of another length than the names.
  Table(std::string_view text, std::string name);
  std::size_t size() const { return rows_.size(); }
  /// A cell as a number. Throws InputError naming table, row and column if it is none.
  double number(std::size_t row, std::string_view column) const;
  const std::string& text(std::size_t row, std::string_view column) const;
  /// A whole column of numbers.
  std::vector<double> numbers(std::string_view column) const;
  /// The rows whose `column` says `value`.
  Table where(std::string_view column, std::string_view value) const;

 private:
  Table() = default;
  std::size_t at(std::string_view column) const;
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace dreampm::validate
