// SPDX-License-Identifier: BSD-3-Clause
// What style sheets in drawings say about their shapes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// The value of a property in "name: value; name: value"; empty if it is not there. The last one counts.
std::string declared(std::string_view declarations, std::string_view name);

/// The rules of <style>: selectors are an element's name, .class, #id, element.class and *, several with
/// commas between them. An id counts more than a class, a class more than a name, and the later of two alike.
class SvgStyleSheet {
 public:
  /// \throws InputError for other selectors and rules that are not closed.
  void add(std::string_view css);
  /// \param classes  of the element, with spaces between them. Empty where no rule says anything.
  std::string property(std::string_view element, std::string_view id, std::string_view classes,
                       std::string_view name) const;

 private:
  struct Rule {
    std::string element, id, group, declarations;  ///< a part that is empty fits all
    int weight = 0;
  };
  std::vector<Rule> rules_;
};

}  // namespace petzval
