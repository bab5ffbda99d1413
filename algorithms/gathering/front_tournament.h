// Which of n fronts is the earliest, and which the latest, while single ones change.
//
// A tournament tree over one integer key per source. Of equal keys the lowest source is the
// earliest and the highest source the latest.
//
// Complexity: O(log n) per changed key at most (mostly less: the walk ends where nothing changes);
// O(n) once after forget(), which is for changing most of them at once. Memory: 16 bytes a source
// and a key, allocated when made.
//
//   FrontTournament fronts(sources);
//   fronts.set(source, key);              // of all sources, before the first question
//   key_of(fronts.latest()) - key_of(fronts.earliest())
#ifndef SIMBENCH_ALGORITHMS_GATHERING_FRONT_TOURNAMENT_H_
#define SIMBENCH_ALGORITHMS_GATHERING_FRONT_TOURNAMENT_H_

#include <cstdint>
#include <vector>

namespace simbench {

class FrontTournament {
 public:
  explicit FrontTournament(std::uint32_t sources);

  void set(std::uint32_t source, std::int64_t key) {
    keys_[source] = key;
    if (played_) replay(source);
  }
  std::int64_t key(std::uint32_t source) const { return keys_[source]; }

  // Until the next question, set() only notes keys.
  void forget() { played_ = false; }

  std::uint32_t earliest() { return champions().earliest; }
  std::uint32_t latest() { return champions().latest; }

 private:
  struct Node {
    std::uint32_t earliest = 0;
    std::uint32_t latest = 0;
    friend bool operator==(const Node&, const Node&) = default;
  };

  const Node& champions() {
    if (!played_) play_all();
    return nodes_[1];
  }
  Node play(const Node& a, const Node& b) const;
  void play_all();
  void replay(std::uint32_t source);

  std::vector<std::int64_t> keys_;
  std::vector<Node> nodes_;  // the children of i are 2i and 2i + 1; leaves from sources on
  bool played_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_FRONT_TOURNAMENT_H_
