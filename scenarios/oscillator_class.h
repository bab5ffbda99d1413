// Classes of oscillators: what a PC's crystal, a TCXO and an OCXO have in common, from one profile
// file per class (scenarios/oscillators/*.json, whose schema documents every member; each value
// names the published figure that it follows from).
//
// A scenario names a class in /hosts/clock/oscillator/class or /cameras/oscillator/class. The
// values of the class replace those of earlier sources (a base); what the file itself, a later one
// or --set states stays. The profiles are built into the program; `simbench list oscillators`
// prints them.
//
// A new class is a new file in that folder, without any other change.
//
//   const OscillatorClass* tcxo = find_oscillator_class("tcxo");
//   const double sigma_ppm = tcxo->find("skew_sigma_ppm")->value;  // 1
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/document.h"

namespace simbench::scenarios {

struct OscillatorValue {
  std::string member;  // of a scenario's oscillator
  double value = 0;
  std::string source;
};

struct OscillatorClass {
  std::string class_name;  // its name in a scenario
  std::string name;        // what it is
  std::vector<OscillatorValue> values;

  const OscillatorValue* find(std::string_view member) const;  // null: not one of them
};

// In alphabetical order.
const std::vector<OscillatorClass>& oscillator_classes();

// Null if there is no such class.
const OscillatorClass* find_oscillator_class(std::string_view class_name);

// Puts the values of the classes that a merged scenario names into its oscillators, with their
// places. Throws InputError for a class that does not exist.
void apply_oscillator_classes(nlohmann::json& scenario, Places& places);

}  // namespace simbench::scenarios
