// One spheroid beside a hyperboloid, half a unit away.
#include <iostream>

#include "hypcheck.h"

int main() {
    std::cout << hypcheck_position(1, 2, 1, 1, 2.5, 0, 0) << '\n' << HYPCHECK_VERSION << ' ' << hypcheck_version() << '\n';
}
