// Boost.Math as evaluation uses it, whose files include it through here: in double, where it would
// take long double, and without vectors of amd64. Both differ from one machine to another; and its
// tables of constants in long double do not start under valgrind.
//
//   const InDouble policy;   // the last parameter of each of its functions and distributions
#pragma once

#ifdef BOOST_MATH_SPECIAL_FUNCTIONS_LANCZOS
#error "include evaluation/statistics/in_double.h in place of Boost.Math"
#endif
// Boost's own guard of its file for SSE2, which sums Lanczos's series (of gamma, beta and all
// distributions) in another order than its file for the other processors.
#define BOOST_MATH_SPECIAL_FUNCTIONS_LANCZOS_SSE2

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/binomial.hpp>

namespace simbench::evaluation {

using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace simbench::evaluation
