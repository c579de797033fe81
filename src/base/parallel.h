// Loops over independent jobs on all threads.
#pragma once

#include <cstddef>

#ifdef KEYHOLE_THREAD_SANITIZER
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace keyhole {

// Calls body(i) for all i in [0, count), in any order and from several threads, and returns when all have ended. An
// exception of a body is passed on, and calls that have not begun may then be left out. Loops may be nested.
// Every call is a task of its own, so it should be worth some microseconds.
#ifndef KEYHOLE_THREAD_SANITIZER
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count),
        [&](const tbb::blocked_range<std::size_t>& jobs) {
            for (std::size_t i = jobs.begin(); i != jobs.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
}

// Calls body() so that loops in it do not take up jobs from outside: for what a thread does under a lock.
template <class Body>
auto isolated(const Body& body) {
    return tbb::this_task_arena::isolate(body);
}
#else
// The thread sanitizer cannot see how TBB's compiled library orders the memory accesses of its threads, and takes every
// loop for a race. With plain threads it sees the races of the bodies, and only those.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr error;
    std::mutex error_mutex;
    const auto work = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) body(i);
        } catch (...) {
            next = count;
            const std::lock_guard lock(error_mutex);
            error = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < std::size_t{4} && i < count; ++i) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    if (error) std::rethrow_exception(error);
}
template <class Body>
auto isolated(const Body& body) {
    return body();
}
#endif

}  // namespace keyhole
