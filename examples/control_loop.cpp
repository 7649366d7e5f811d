// A control loop as a ROS node has it: at each pose it asks whether the drone, flying on as it does, meets a tree soon.
//
//     c++ -std=c++17 -O2 -I FOLDER_OF_HYPCHECK_H control_loop.cpp -o control_loop && ./control_loop
//
// In a node, `Guard::ahead` is called from the callback of the pose, on the thread that controls: it allocates nothing
// once the trees are known, and an answer takes about a microsecond a tree.

#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

struct Tree {
    double alpha, gamma, x, y, z_min, z_max;
};

struct Contact {
    int tree;       // -1: none within the horizon
    double seconds; // no contact comes before
};

class Guard {
  public:
    Guard(double b, double d, std::vector<Tree> trees)
        : b_(b), d_(d), trees_(std::move(trees)), rows_(trees_.size()), hits_(trees_.size()), times_(trees_.size()) {}

    // The first contact of the drone on its straight way through the next seconds. What bounds do not tell counts as
    // contact at once: a guard stops rather than guesses.
    Contact ahead(const std::array<double, 3> &at, const std::array<double, 3> &speed, double horizon) {
        for (size_t i = 0; i < trees_.size(); i++) {
            const Tree &tree = trees_[i];
            rows_[i] = {tree.alpha, tree.gamma, b_, d_, // the way in the tree's frame
                        at[0] - tree.x, at[1] - tree.y, at[2],
                        at[0] - tree.x + horizon * speed[0], at[1] - tree.y + horizon * speed[1], at[2] + horizon * speed[2],
                        0, 0, 1, tree.z_min, tree.z_max, 1};
        }
        hypcheck_passage_columns(trees_.size(), 16, rows_[0].data(), hits_.data(), times_.data());
        Contact first{-1, horizon};
        for (size_t i = 0; i < trees_.size(); i++) {
            if (hits_[i] == 0) continue;
            const bool known = hits_[i] == 1 && !std::isnan(times_[i]);
            const double seconds = known ? times_[i] * horizon : 0;
            if (first.tree < 0 || seconds < first.seconds) first = {static_cast<int>(i), seconds};
        }
        return first;
    }

  private:
    double b_, d_;
    std::vector<Tree> trees_;
    std::vector<std::array<double, 16>> rows_;
    std::vector<int8_t> hits_;
    std::vector<double> times_;
};

int main() {
    Guard guard(0.4, 0.2, {{0.3, 5, 6, 0.1, -1, 8}, {0.3, 5, 12, -0.2, -1, 2}, {0.5, 4, 18, 0, -1, 9}});
    std::array<double, 3> at{0, 0, 1.5}, speed{2, 0, 0};
    const double step = 0.02, horizon = 1.5; // 50 Hz
    for (int tick = 0; tick < 1000; tick++) {
        const Contact next = guard.ahead(at, speed, horizon);
        if (next.tree >= 0 && speed[2] == 0) { // climb over what has a top, and fly on
            std::printf("%.2f s: tree %d in %.3f s; climbing\n", tick * step, next.tree, next.seconds);
            speed = {0, 0, 2};
        } else if (next.tree < 0 && speed[2] > 0) {
            const Contact on = guard.ahead(at, {2, 0, 0}, horizon);
            if (on.tree < 0) {
                std::printf("%.2f s: clear at %.2f m; flying on\n", tick * step, at[2]);
                speed = {2, 0, 0};
            }
        } else if (next.tree >= 0) {
            std::printf("%.2f s: tree %d in %.3f s; stopping\n", tick * step, next.tree, next.seconds);
            return 1;
        }
        for (int k = 0; k < 3; k++) at[k] += step * speed[k];
        if (at[0] > 21) {
            std::printf("%.2f s: past the trees at %.2f m\n", tick * step, at[2]);
            return 0;
        }
    }
    return 2;
}
