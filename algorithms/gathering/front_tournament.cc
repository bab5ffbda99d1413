#include "algorithms/gathering/front_tournament.h"

#include <cstddef>

namespace simbench {

FrontTournament::FrontTournament(std::uint32_t sources)
    : keys_(sources), nodes_(std::size_t{2} * sources) {
  for (std::uint32_t source = 0; source < sources; ++source) {
    nodes_[std::size_t{sources} + source] = {source, source};
  }
}

FrontTournament::Node FrontTournament::play(const Node& a, const Node& b) const {
  const auto before = [this](std::uint32_t x, std::uint32_t y) {
    return keys_[x] != keys_[y] ? keys_[x] < keys_[y] : x < y;
  };
  return {before(b.earliest, a.earliest) ? b.earliest : a.earliest,
          before(a.latest, b.latest) ? b.latest : a.latest};
}

void FrontTournament::play_all() {
  for (std::size_t i = keys_.size() - 1; i > 0; --i) {
    nodes_[i] = play(nodes_[2 * i], nodes_[2 * i + 1]);
  }
  played_ = true;
}

void FrontTournament::replay(std::uint32_t source) {
  for (std::size_t i = (keys_.size() + source) / 2; i > 0; i /= 2) {
    const Node node = play(nodes_[2 * i], nodes_[2 * i + 1]);
    // Nodes above see this one's champions alone: nothing changes there if these are the same and
    // kept their keys.
    if (node == nodes_[i] && node.earliest != source && node.latest != source) return;
    nodes_[i] = node;
  }
}

}  // namespace simbench
