#!/usr/bin/env bash
# The rules of tools/lint that read the project as text, each over files that are made up: what it
# finds, and what it leaves alone.
set -euo pipefail
source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# expect RULE FILE... < findings: exactly these, in this order.
expect() {
  local rule=$1 wanted found
  shift
  wanted=$(cat)
  found=$(awk -f "$source_root/tools/$rule" "$@" | sort)
  [[ $found == "$wanted" ]] || { diff <(printf '%s\n' "$wanted") <(printf '%s\n' "$found") >&2; exit 1; }
}

mkdir -p sim/rig hardware app
cat > sim/rig/camera.h <<'FILE'
struct Frame;
enum class Kind : int { kOne };
class Camera final : public Source {
  struct Nested {};
};
struct [[nodiscard]] Outcome {
};
struct Lane {};
FILE
cat > sim/lane.h <<'FILE'
struct Lane {
};
FILE
cat > hardware/camera.h <<'FILE'
class Camera {
};
struct Nested {
};
struct Frame {
};
FILE
cat > app/local.cc <<'FILE'
namespace {
struct Kind {
};
struct Local {
};
}
FILE
cat > hardware/local.cc <<'FILE'
struct Local {
};
struct Outcome : Base {
};
FILE
mkdir scenarios
cat > scenarios/schema.json <<'FILE'
{"x-type": "Frame",
 "x-type": "Cable", "x-types": "Kind"}
FILE
expect type_names.awk sim/rig/camera.h sim/lane.h hardware/camera.h app/local.cc hardware/local.cc \
  scenarios/schema.json <<'FOUND'
app/local.cc:2: Kind names a type of another folder too (sim/rig/camera.h:2): a name means one thing
hardware/camera.h:1: Camera names a type of another folder too (sim/rig/camera.h:3): a name means one thing
hardware/local.cc:3: Outcome names a type of another folder too (sim/rig/camera.h:6): a name means one thing
scenarios/schema.json:1: Frame names a type of another folder too (hardware/camera.h:5): a name means one thing
FOUND

cat > text.cc <<'FILE'
// Of a camera, the newest frame.
int x = 0;  // So much of it. Likewise the rest
// It is late. Not so where it waits; Nor here.
// A frame of a camera is so late that neither it nor another counts: Southern, Offer, Nora.
// Not thread-safe.
const char* url = "http://So far";
const char* code = "Of Of Of";
FILE
cat > page.md <<'FILE'
So it is.
- Of many, one. **It is bold.** Nor is this.

    So is code.

```
Of code.
```
The value `x. So` is code (not text.) So this is found.
FILE
cat > script.sh <<'FILE'
# Nor this.
echo "So what"
FILE
expect openers.awk text.cc page.md script.sh <<'FOUND'
page.md:1: a sentence opens with "So": begin with its subject
page.md:2: a sentence opens with "Nor": begin with its subject
page.md:2: a sentence opens with "Of": begin with its subject
page.md:9: a sentence opens with "So": begin with its subject
script.sh:1: a sentence opens with "Nor": begin with its subject
text.cc:1: a sentence opens with "Of": begin with its subject
text.cc:2: a sentence opens with "Likewise": begin with its subject
text.cc:2: a sentence opens with "So": begin with its subject
text.cc:3: a sentence opens with "Nor": begin with its subject
text.cc:3: a sentence opens with "Not so": begin with its subject
FOUND
