#include "cli/embedding.h"

namespace simbench::cli {
namespace {

Embedding* current = nullptr;

}  // namespace

Embedding* embedding() { return current; }

EmbeddingScope::EmbeddingScope(Embedding& within) { current = &within; }

EmbeddingScope::~EmbeddingScope() { current = nullptr; }

}  // namespace simbench::cli
