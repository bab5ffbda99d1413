#include "bags/bag.h"

namespace simbench::bags {

BagFacts read_sqlite_bag(const std::string& path, BagSink& /*sink*/,
                         const ReadProgress& /*progress*/) {
  throw BagError(path + ": this format is not read yet");
}

}  // namespace simbench::bags
