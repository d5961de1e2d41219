// Stands before libc and answers what the time is: always the same, or each time another.
#include <sys/random.h>
#include <sys/time.h>
#include <time.h>

#include <cstdint>

namespace {

timespec answer() {
#ifdef LACQUER_WILD
  uint64_t random = 0;
  if (getrandom(&random, sizeof(random), 0) != static_cast<ssize_t>(sizeof(random))) random = 1;
  constexpr uint64_t kCentury = 3155760000;
  constexpr uint64_t kSecond = 1000000000;
  return {static_cast<time_t>(random % kCentury), static_cast<long>(random / kCentury % kSecond)};
#else
  return {0, 0};
#endif
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t, timespec* time) noexcept {
  *time = answer();
  return 0;
}

int clock_getres(clockid_t, timespec* resolution) noexcept {
  if (resolution != nullptr) *resolution = {0, 1};
  return 0;
}

int timespec_get(timespec* time, int base) noexcept {
  *time = answer();
  return base;
}

int gettimeofday(timeval* time, void*) noexcept {
  const timespec now = answer();
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* time) noexcept {
  const timespec now = answer();
  if (time != nullptr) *time = now.tv_sec;
  return now.tv_sec;
}

clock_t clock() noexcept { return answer().tv_sec; }
}
