// How a scenario file changes its base: the JSON merge patch of RFC 7386, and what that lacks for
// lists of objects.
//
//  - Objects are merged member by member; null removes a member; all else replaces what was there.
//  - A list replaces the base's, with one exception. An element that is an object and lacks a
//    member which it must have by the schema stands for the base's element at its place, changed by
//    the members that it states (merged by these rules); {} is the base's element as it is. It
//    needs such an element there, else it is incomplete, which the schema refuses. An element with
//    all that it must have stands for itself: nothing of the base's goes into it.
//  - The list is as long as the file's: elements of the base beyond it are gone.
//  - Pipelines and published figures go by names, never by place: their lists are replaced.
//
// Files that were valid without the exception mean what they meant: their elements are complete.
// Source: RFC 7386; docs/files.md (Scenarios).
// The layers of a scenario (scenarios/document.h) are its patches, the base's base first.
#pragma once

#include <nlohmann/json.hpp>

#include "scenarios/document.h"

namespace simbench::scenarios {

// Applies `patch` to `target`, whose places follow.
void merge_patch(const nlohmann::json& patch, const Places& patch_places, nlohmann::json& target,
                 Places& places);

}  // namespace simbench::scenarios
