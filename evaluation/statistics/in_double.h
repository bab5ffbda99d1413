// Boost.Math in double, where it would take long double: that differs from one machine to another,
// and its tables of constants do not start under valgrind.
//
//   const InDouble policy;   // the last parameter of each of its functions and distributions
#ifndef SIMBENCH_EVALUATION_STATISTICS_IN_DOUBLE_H_
#define SIMBENCH_EVALUATION_STATISTICS_IN_DOUBLE_H_

#include <boost/math/policies/policy.hpp>

namespace simbench::evaluation {

using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_IN_DOUBLE_H_
