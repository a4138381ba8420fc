#include "tools/evaluation/figures.hpp"

#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>

namespace hairpin {
namespace {

void PrintLines(const nlohmann::json& figures, const std::string& prefix) {
  for (const auto& [key, value] : figures.items()) {
    if (value.is_object()) {
      PrintLines(value, prefix + key + ".");
    } else {
      std::cout << std::left << std::setw(30) << prefix + key << ' ' << value << '\n';
    }
  }
}

}  // namespace

void PrintFigures(const nlohmann::json& figures, bool as_json) {
  if (as_json) {
    std::cout << figures.dump(2) << '\n';
  } else {
    PrintLines(figures, "");
  }
}

void WriteFile(const std::string& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace hairpin
