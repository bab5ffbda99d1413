#include "sim/programs/cables.h"

#include <algorithm>

namespace simbench::sim {

Cables::Cables(const scenarios::Hosts& parameters, const scenarios::Network& network, PeerId host,
               std::size_t hosts) {
  if (network.switch_clock != scenarios::SwitchClockKind::kTransparent) return;
  std::vector<std::uint32_t> degrees(hosts);
  if (host != 0) neighbours_.push_back(scenarios::followed_host(parameters, host));
  for (PeerId each = 1; each < hosts; ++each) {
    const PeerId followed = scenarios::followed_host(parameters, each);
    ++degrees[each];
    ++degrees[followed];
    if (followed == host && neighbours_.size() < kMostCards) neighbours_.push_back(each);
  }
  const std::uint32_t most = hosts == 0 ? 0 : *std::ranges::max_element(degrees);
  cards_ = std::clamp<std::uint32_t>(most, 1, kMostCards);
}

std::uint32_t Cables::carriers() const {
  std::uint32_t carriers = 1;
  for (std::size_t card = 0; card < neighbours_.size(); ++card) carriers |= 1U << card;
  return carriers;
}

std::optional<PeerId> Cables::neighbour(std::uint32_t card) const {
  if (card >= neighbours_.size()) return std::nullopt;
  return neighbours_[card];
}

std::optional<std::uint32_t> Cables::card_to(PeerId host) const {
  const auto found = std::ranges::find(neighbours_, host);
  if (found == neighbours_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - neighbours_.begin());
}

}  // namespace simbench::sim
