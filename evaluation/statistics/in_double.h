// Boost.Math in double, where it would take long double: that differs from one machine to another,
// and its tables of constants do not start under valgrind.
//
//   const InDouble policy;   // the last parameter of each of its functions and distributions
#pragma once

#include <boost/math/policies/policy.hpp>

namespace simbench::evaluation {

using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace simbench::evaluation
