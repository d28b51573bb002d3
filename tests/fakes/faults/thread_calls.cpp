/// Threads that the program starts, through the standard library.
#include "tests/fakes/faults/fault.h"
#include <pthread.h>

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                              void* data) noexcept {
  static faults::Call call("pthread_create");
  static auto* const next =
      faults::real<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  if (faults::is_running() && faults::called_by_program() && faults::strikes(call)) return faults::code();
  return next(thread, attributes, body, data);
}
