// A member, or what a function makes, of each element of a list.
//
//   const std::vector<std::string> names =
//       collected(scenario.pipelines, &scenarios::Pipeline::name);
#pragma once

#include <functional>
#include <type_traits>
#include <vector>

namespace simbench {

template <class List, class Projection>
auto collected(List&& list, const Projection& projection) {
  std::vector<std::decay_t<decltype(std::invoke(projection, *list.begin()))>> all;
  all.reserve(list.size());
  for (auto&& element : list) all.push_back(std::invoke(projection, element));
  return all;
}

}  // namespace simbench
