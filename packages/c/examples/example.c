/* Three spheroids at a tower: inside, through the wall, outside. */
#include <stdio.h>

#include "hypcheck.h"

int main(void)
{
    const double tower[4] = {2, 17.8, 0.25, 0.15}; /* alpha, gamma, b, d */
    const double x[3] = {0, 1.9, 3}, y[3] = {0, 0, 0}, z[3] = {5, 5, 5};
    int8_t positions[3];

    hypcheck_classify_scene(tower, 3, x, y, z, positions);
    printf("%d %d %d\n", positions[0], positions[1], positions[2]);
    printf("%s %s\n", HYPCHECK_VERSION, hypcheck_version());
    return 0;
}
