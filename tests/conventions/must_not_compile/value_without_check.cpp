// A result is not its value: the error has to be looked at first.

#include "input/base/error.hpp"

int read(const limn::Expected<int>& result) {
#ifdef LIMN_MUST_NOT_COMPILE
  return result;
#else
  return result ? *result : 0;
#endif
}
