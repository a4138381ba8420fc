#include "tools/race/fault.hpp"

#include <algorithm>
#include <regex>

#include "common/config.hpp"

namespace hairpin {

bool Fault::ActiveAt(double seconds_since_go) const {
  return seconds_since_go >= start && (!duration || seconds_since_go < start + *duration);
}

Fault ParseFault(const std::string& text, const std::vector<std::string>& sources) {
  static const std::regex kGrammar(
      R"(\s*(\w+)\s+off\s+at\s+(\d+(?:\.\d+)?)\s*s(?:\s+for\s+(\d+(?:\.\d+)?)\s*s)?\s*)");
  std::smatch match;
  if (!std::regex_match(text, match, kGrammar)) {
    throw FaultError("fault `" + text + "`: expected `SOURCE off at SECONDS s [for SECONDS s]`");
  }
  const std::string source = match[1];
  if (std::find(sources.begin(), sources.end(), source) == sources.end()) {
    const std::string nearest = Nearest(source, sources);
    std::string known;
    for (const std::string& name : sources) known += (known.empty() ? "" : ", ") + name;
    throw FaultError("fault `" + text + "`: no source " + source + " (" +
                     (nearest.empty() ? "" : "did you mean " + nearest + "? ") + "known: " + known +
                     ")");
  }
  Fault fault{source, std::stod(match[2]), std::nullopt};
  if (match[3].matched) fault.duration = std::stod(match[3]);
  return fault;
}

}  // namespace hairpin
