// The operations of a contact on its fields, compiled when the first contact of a program is solved. The names and the
// meaning are those of the trait `Fields`. `state` is the precision of pressure, gap and displacement, defined before
// this text.

typedef unsigned long long place;

// The cells of all contacts, row by row. `first` is the flat cell at which a row begins, `padded` its first value in the
// padded buffer of transforms.
struct Contacts {
    const place* first;
    const place* padded;
    const int* length;
    const int* around; // contact, row in it, and the rows 2 before, 1 before, 1 after and 2 after; -1 without such a row
    int rows;
    state* pressure;
    state* touch; // h + u
    state* gap;
    state* kept; // the last feasible pressure
    const state* upper; // null if the upper bound is `cap` for all cells
    double cap;
    float* direction;
    unsigned char* set;
    unsigned char* pattern; // which of the causal neighbours of a free cell are free
};

enum { FREE = 0, LOWER = 1, UPPER = 2 };

// Executes what follows, up to END, for each cell `c`, whose value in the buffer is `b`.
#define CELLS                                                                                      \
    for (int row = blockIdx.x; row < f.rows; row += gridDim.x) {                                   \
        const place first = f.first[row], before = f.padded[row];                                  \
        const int length = f.length[row];                                                          \
        for (int j = threadIdx.x; j < length; j += blockDim.x) {                                   \
            const place c = first + j, b = before + j;
#define END }}

#define UPPER_BOUND (f.upper ? (double)f.upper[c] : f.cap)

__device__ double clip(double p, double upper) { return p < 0 ? 0 : (p > upper ? upper : p); }

// Results of a block of threads, in a fixed order: `N` numbers, of which the first `sums` are added and the others
// replaced by the larger one.
template <int N> __device__ void merge(double (&own)[N], int sums, double* parts) {
    __shared__ double all[N][256];
    for (int k = 0; k < N; k++) all[k][threadIdx.x] = own[k];
    __syncthreads();
    for (int half = blockDim.x / 2; half > 0; half /= 2) {
        if (threadIdx.x < half)
            for (int k = 0; k < N; k++) {
                const double other = all[k][threadIdx.x + half];
                double& mine = all[k][threadIdx.x];
                if (k < sums) mine += other;
                else mine = other > mine ? other : mine;
            }
        __syncthreads();
    }
    if (threadIdx.x == 0)
        for (int k = 0; k < N; k++) parts[blockIdx.x * 8 + k] = all[k][0];
}

#define MERGE(N, sums) merge<N>(own, sums, parts)
#define LEAST (-1.0 / 0.0)
#define LARGER(mine, other) do { const double it = other; if (it > mine) mine = it; } while (0)

extern "C" {

// Merges the results of all blocks.
__global__ void merge_blocks(const double* parts, int blocks, int numbers, int sums, double* results) {
    double own[8];
    for (int k = 0; k < numbers; k++) {
        own[k] = k < sums ? 0 : LEAST;
        for (int block = threadIdx.x; block < blocks; block += blockDim.x) {
            const double other = parts[block * 8 + k];
            if (k < sums) own[k] += other;
            else LARGER(own[k], other);
        }
    }
    for (int k = numbers; k < 8; k++) own[k] = 0;
    merge<8>(own, sums, results);
}

__global__ void bounds(Contacts f, double* parts) {
    double own[2] = {0, 0};
    CELLS
        own[0] += UPPER_BOUND;
        LARGER(own[1], UPPER_BOUND);
    END
    MERGE(2, 1);
}

__global__ void set_uniform(Contacts f, double value) {
    CELLS f.pressure[c] = value; END
}

__global__ void close_alone(Contacts f, double approach, double stiffness) {
    CELLS f.pressure[c] = stiffness * (approach - (double)f.gap[c]); END
}

__global__ void scale_below(Contacts f, double factor, double* parts) {
    double own[2] = {0, 0};
    CELLS
        const double upper = UPPER_BOUND;
        double p = f.pressure[c];
        p = p < upper ? clip(p * factor, upper) : upper;
        f.pressure[c] = p;
        p = f.pressure[c];
        own[0] += p;
        if (p < upper) own[1] += p;
    END
    MERGE(2, 2);
}

__global__ void propose(Contacts f, state* buffer, double approach, double stiffness, double* parts) {
    double own[2] = {LEAST, LEAST};
    CELLS
        double y = f.pressure[c];
        if (stiffness > 0) y += (approach - (double)f.touch[c]) * stiffness;
        buffer[b] = y;
        y = buffer[b];
        LARGER(own[0], -y);
        LARGER(own[1], y);
    END
    MERGE(2, 0);
}

__global__ void proposed_sum(Contacts f, const state* buffer, double offset, double* parts) {
    double own[2] = {0, 0};
    CELLS
        const double upper = UPPER_BOUND, p = clip((double)buffer[b] + offset, upper);
        own[0] += p;
        if (p > 0 && p < upper) own[1] += 1;
    END
    MERGE(2, 2);
}

__global__ void accept(Contacts f, const state* buffer, double offset) {
    CELLS f.pressure[c] = clip((double)buffer[b] + offset, UPPER_BOUND); END
}

__global__ void load_pressure(Contacts f, state* buffer, int kept) {
    CELLS buffer[b] = kept ? f.kept[c] : f.pressure[c]; END
}

__global__ void take_touch(Contacts f, const state* buffer) {
    CELLS f.touch[c] = f.gap[c] + buffer[b]; END
}

__global__ void multiplier(Contacts f, double* parts) {
    double own[3] = {0, 0, LEAST};
    CELLS
        const double p = f.pressure[c], t = f.touch[c];
        if (p > 0 && p < UPPER_BOUND) {
            own[0] += p;
            own[1] += p * t;
        } else if (p > 0)
            LARGER(own[2], t);
    END
    MERGE(3, 2);
}

__global__ void residual(Contacts f, double approach, double self_influence, double* parts) {
    double own[5] = {0, 0, 0, 0, 0};
    CELLS
        const double p = f.pressure[c], t = f.touch[c], u = t - (double)f.gap[c];
        const double to = clip(p + (approach - t) / self_influence, UPPER_BOUND);
        own[0] += u;
        own[1] += u * u;
        LARGER(own[2], fabs(self_influence * (p - to)));
        LARGER(own[3], fabs(p));
        LARGER(own[4], fabs(u));
    END
    MERGE(5, 2);
}

__global__ void predict_sets(Contacts f, const state* buffer, double offset, double* parts) {
    double own[4] = {0, 0, 0, 0};
    CELLS
        const double y = (double)buffer[b] + offset, upper = UPPER_BOUND, p = f.pressure[c];
        const unsigned char set = y <= 0 ? LOWER : (y >= upper ? UPPER : FREE);
        f.set[c] = set;
        if (set == FREE) {
            own[0] += 1;
            own[3] += clip(p, upper);
        } else {
            const double d = (set == LOWER ? 0 : upper) - p;
            if (d != 0) own[1] += 1;
            own[2] += d;
        }
    END
    MERGE(4, 4);
}

__global__ void direct_to_bounds(Contacts f, float* buffer, double each, double per_pressure) {
    CELLS
        const double upper = UPPER_BOUND, p = f.pressure[c];
        const unsigned char set = f.set[c];
        const float d = set == FREE ? -each - per_pressure * clip(p, upper) : (set == LOWER ? 0 : upper) - p;
        f.direction[c] = set == FREE ? d : 0;
        buffer[b] = d;
    END
}

__global__ void arrive(Contacts f, const float* buffer) {
    CELLS
        const unsigned char set = f.set[c];
        f.pressure[c] = set == FREE ? (double)f.pressure[c] + (double)f.direction[c] : (set == LOWER ? 0 : UPPER_BOUND);
        f.touch[c] = (double)f.touch[c] + (double)buffer[b];
    END
}

__global__ void touch_sum(Contacts f, double* parts) {
    double own[1] = {0};
    CELLS if (f.set[c] == FREE) own[0] += (double)f.touch[c]; END
    MERGE(1, 1);
}

__global__ void advance(Contacts f, float* buffer, double step, double datum, double self_influence, double* parts) {
    double own[3] = {0, 0, 0};
    CELLS
        const unsigned char set = f.set[c];
        double p = f.pressure[c], t = f.touch[c], r = 0;
        if (step != 0) {
            t += step * (double)buffer[b];
            f.touch[c] = t;
            t = f.touch[c];
        }
        const double w = datum - t;
        double violation;
        if (set == FREE) {
            if (step != 0) {
                p += step * (double)f.direction[c];
                f.pressure[c] = p;
            }
            r = w;
            violation = self_influence * (p - clip(p, UPPER_BOUND));
        } else
            violation = (set == LOWER) == (w > 0) ? w : 0;
        buffer[b] = r;
        own[0] += r * r;
        own[1] += violation * violation;
        LARGER(own[2], fabs(r));
    END
    MERGE(3, 2);
}

__global__ void products(Contacts f, const float* buffer, double datum, double* parts) {
    double own[3] = {0, 0, 0};
    CELLS
        if (f.set[c] == FREE) {
            const double z = buffer[b], r = datum - (double)f.touch[c];
            own[0] += z;
            own[1] += r;
            own[2] += r * z;
        }
    END
    MERGE(3, 3);
}

// The preconditioner on the free cells, see nodes.rs and the sparse inverse of the processor.

#define NEIGHBOURS 6
#define MEMBERS (NEIGHBOURS + 1)
__constant__ int CAUSAL[NEIGHBOURS][2] = {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {-2, 0}, {0, -2}};

// The flat cell and the place in the buffer of the cell `sign` times a causal neighbour away; whether there is one. Columns
// `wrap` if they are periodic.
__device__ bool neighbour(const Contacts& f, int row, int j, int k, int sign, int wrap, place* c, place* b) {
    const int rows = sign * CAUSAL[k][0];
    const int other = rows == 0 ? row : f.around[6 * row + (rows < 0 ? 4 : 3) + rows];
    int column = j + sign * CAUSAL[k][1];
    if (other < 0) return false;
    const int length = f.length[other];
    if (column < 0 || column >= length) {
        if (!wrap) return false;
        column += column < 0 ? length : -length;
    }
    *c = f.first[other] + column;
    *b = f.padded[other] + column;
    return true;
}

__global__ void patterns(Contacts f, int wrap) {
    CELLS
        unsigned char pattern = 0;
        place other, at;
        if (f.set[c] == FREE)
            for (int k = 0; k < NEIGHBOURS; k++)
                if (neighbour(f, row, j, k, 1, wrap, &other, &at) && f.set[other] == FREE) pattern |= 1 << k;
        f.pattern[c] = pattern;
    END
}

// The image under G: a row of `inverse` for each pattern.
__global__ void to_factor(Contacts f, const float* buffer, float* image, const float* inverse, int wrap) {
    CELLS
        float product = 0;
        place other, at;
        if (f.set[c] == FREE) {
            const float* g = inverse + MEMBERS * f.pattern[c];
            product = g[NEIGHBOURS] * buffer[b];
            for (int k = 0; k < NEIGHBOURS; k++)
                if (f.pattern[c] >> k & 1 && neighbour(f, row, j, k, 1, wrap, &other, &at)) product += g[k] * buffer[at];
        }
        image[c] = product;
    END
}

// The image under the transpose of G.
__global__ void from_factor(Contacts f, float* buffer, const float* image, const float* inverse, int wrap) {
    CELLS
        float z = 0;
        place other, at;
        if (f.set[c] == FREE) {
            z = inverse[MEMBERS * f.pattern[c] + NEIGHBOURS] * image[c];
            for (int k = 0; k < NEIGHBOURS; k++)
                if (neighbour(f, row, j, k, -1, wrap, &other, &at) && f.pattern[other] >> k & 1)
                    z += inverse[MEMBERS * f.pattern[other] + k] * image[other];
        }
        buffer[b] = z;
    END
}

// Nodes over the padded cells of each contact, row by row.
struct Nodes {
    const int* shapes; // rows and columns of each contact
    const int* starts; // the row at which each contact begins
    int contacts;
    int rows, columns; // number of nodes along each axis
    int stride; // values from a row of nodes to the next
    int width; // columns of the widest contact
    double spacing[2]; // cells between two nodes
    float* lines; // for each row of nodes, a sum over the cells of each column
    float* weight;
    float* restricted;
    float* solved;
};

// Position of a cell along an axis, in nodes.
__device__ double position(int cell, double spacing) { return (cell + 0.5) / spacing - 0.5; }

// Adds the values of the cells along an axis, each by its share of a node. The images of the node count as itself.
#define ON_NODE(sum, node, nodes, spacing, cells, cell, value)                                     \
    for (int image = (node) - (nodes); image <= (node) + (nodes); image += (nodes)) {              \
        const int from = (int)floor((image - 0.5) * (spacing)), to = (int)ceil((image + 1.5) * (spacing)); \
        for (int cell = from < 0 ? 0 : from; cell < to && cell < (cells); cell++) {                \
            const double share = 1 - fabs(position(cell, spacing) - image);                        \
            if (share > 0) sum += share * (value);                                                 \
        }                                                                                          \
    }

// Sums along x of the values of the free cells in the buffer; without a buffer, of 1 for each free cell.
__global__ void sum_lines(Contacts f, const float* buffer, Nodes n) {
    for (int at = blockIdx.x; at < n.contacts * n.rows; at += gridDim.x) {
        const int contact = at / n.rows, node = at % n.rows, start = n.starts[contact];
        for (int j = threadIdx.x; j < n.shapes[2 * contact + 1]; j += blockDim.x) {
            double sum = 0;
            ON_NODE(sum, node, n.rows, n.spacing[0], n.shapes[2 * contact], i,
                    buffer ? (double)buffer[f.padded[start + i] + j] : (f.set[f.first[start + i] + j] == FREE ? 1.0 : 0.0))
            n.lines[(place)at * n.width + j] = sum;
        }
    }
}

// Executes what follows, up to END_NODES, for each node `c`, with the `sum` of the values of its cells by their shares.
#define ON_NODES                                                                                   \
    for (int at = blockIdx.x; at < n.contacts * n.rows; at += gridDim.x)                           \
        for (int node = threadIdx.x; node < n.columns; node += blockDim.x) {                       \
            const place c = (place)at * n.stride + node;                                           \
            double sum = 0;                                                                        \
            ON_NODE(sum, node, n.columns, n.spacing[1], n.shapes[2 * (at / n.rows) + 1], j, n.lines[(place)at * n.width + j])
#define END_NODES }

__global__ void set_weight(Nodes n, double least) {
    ON_NODES n.weight[c] = 1 / (sum / (n.spacing[0] * n.spacing[1]) + least); END_NODES
}

__global__ void set_restricted(Nodes n) {
    ON_NODES n.restricted[c] = n.solved[c] = n.weight[c] * sum; END_NODES
}

__global__ void set_solved(Nodes n) {
    ON_NODES n.solved[c] = n.weight[c] * (n.solved[c] - sum / (n.spacing[0] * n.spacing[1])); END_NODES
}

// Adds the interpolated restricted residual, or the solution of the nodes, times a factor to the free cells.
__global__ void interpolate(Contacts f, float* buffer, Nodes n, int solved, double factor) {
    CELLS
        if (f.set[c] == FREE) {
            const double x = position(f.around[6 * row + 1], n.spacing[0]), y = position(j, n.spacing[1]);
            const int i = (int)floor(x), k = (int)floor(y);
            const double s = x - i, t = y - k;
            const float* nodes = (solved ? n.solved : n.restricted) + (place)f.around[6 * row] * n.rows * n.stride;
            const float* one = nodes + (place)((i + n.rows) % n.rows) * n.stride;
            const float* two = nodes + (place)((i + 1) % n.rows) * n.stride;
            const int left = (k + n.columns) % n.columns, right = (k + 1) % n.columns;
            const double value = (1 - s) * ((1 - t) * one[left] + t * one[right]) + s * ((1 - t) * two[left] + t * two[right]);
            buffer[b] += factor * value;
        }
    END
}

__global__ void direct(Contacts f, float* buffer, double mean, double beta) {
    CELLS
        const float d = f.set[c] == FREE ? (double)buffer[b] - mean + beta * (double)f.direction[c] : 0;
        f.direction[c] = d;
        buffer[b] = d;
    END
}

__global__ void response(Contacts f, const float* buffer, double* parts) {
    double own[2] = {0, 0};
    CELLS
        if (f.set[c] == FREE) {
            const double v = buffer[b];
            own[0] += v * (double)f.direction[c];
            own[1] += v;
        }
    END
    MERGE(2, 2);
}

__global__ void pressure_sum(Contacts f, double* parts) {
    double own[1] = {0};
    CELLS own[0] += (double)f.pressure[c]; END
    MERGE(1, 1);
}

__global__ void add_to_free(Contacts f, double pressure) {
    CELLS if (f.set[c] == FREE) f.pressure[c] = (double)f.pressure[c] + pressure; END
}

__global__ void step_along_gap(Contacts f, double approach, double compliance) {
    CELLS f.pressure[c] = (double)f.pressure[c] + (approach - (double)f.touch[c]) / compliance; END
}

__global__ void descent(Contacts f, const state* buffer, double approach, double* parts) {
    double own[2] = {0, 0};
    CELLS
        const double before = (double)f.gap[c] + (double)buffer[b];
        const double change = (double)f.pressure[c] - (double)f.kept[c];
        own[0] += (approach - before) * change;
        own[1] += change * ((double)f.touch[c] - before);
    END
    MERGE(2, 2);
}

__global__ void step_from_kept(Contacts f, const state* buffer, double share) {
    CELLS
        const double before = (double)f.gap[c] + (double)buffer[b], kept = f.kept[c];
        f.touch[c] = before + share * ((double)f.touch[c] - before);
        f.pressure[c] = kept + share * ((double)f.pressure[c] - kept);
    END
}

// Sets the values of the padded buffer outside of the contacts to 0. `rows` and `columns` of a contact are `shapes`.
#define CLEAR_OUTSIDE(name, real)                                                                  \
    __global__ void name(real* buffer, const int* shapes, int contacts, int rows, int stride) {    \
        for (place row = blockIdx.x; row < (place)contacts * rows; row += gridDim.x) {             \
            const int contact = row / rows, i = row % rows;                                        \
            const int from = i < shapes[2 * contact] ? shapes[2 * contact + 1] : 0;                \
            for (int j = from + threadIdx.x; j < stride; j += blockDim.x) buffer[row * stride + j] = 0; \
        }                                                                                          \
    }
CLEAR_OUTSIDE(clear_outside, state)
CLEAR_OUTSIDE(clear_outside_single, float)

// Multiplies the transforms by a spectrum over the number of values: a table of the frequencies up to half of each axis,
// or, without a table, the factor `constant`/|q| if `inverse` is 1 and `constant` |q| if it is 0, with `at_zero` at q = 0.
struct Spectrum {
    const state* table;
    double constant;
    double at_zero;
    double unit[2]; // angular wavenumber of the first frequency along each axis
    int inverse;
};

#define MULTIPLY(name, real)                                                                       \
    __global__ void name(real* buffer, Spectrum s, int contacts, int rows, int half, double scale) { \
        for (place row = blockIdx.x; row < (place)contacts * rows; row += gridDim.x) {             \
            const int i = row % rows, k = i <= rows - i ? i : rows - i;                            \
            real* values = buffer + 2 * row * half;                                                \
            for (int l = threadIdx.x; l < half; l += blockDim.x) {                                 \
                double factor;                                                                     \
                if (s.table)                                                                       \
                    factor = s.table[(place)k * half + l];                                         \
                else {                                                                             \
                    const double x = k * s.unit[0], y = l * s.unit[1], q = sqrt(x * x + y * y);     \
                    factor = q > 0 ? (s.inverse ? s.constant / q : s.constant * q) : s.at_zero;    \
                }                                                                                  \
                factor *= scale;                                                                   \
                values[2 * l] = (real)((double)values[2 * l] * factor);                            \
                values[2 * l + 1] = (real)((double)values[2 * l + 1] * factor);                    \
            }                                                                                      \
        }                                                                                          \
    }
MULTIPLY(multiply, state)
MULTIPLY(multiply_single, float)

// Continues the influence of a cell, given for the distances up to half of each axis, to the whole padded buffer.
__global__ void spread_influence(state* buffer, const state* influence, int rows, int columns, int stride) {
    const int width = columns / 2 + 1;
    for (int i = blockIdx.x; i < rows; i += gridDim.x)
        for (int j = threadIdx.x; j < columns; j += blockDim.x) {
            const int k = i <= rows - i ? i : rows - i, l = j <= columns - j ? j : columns - j;
            buffer[(place)i * stride + j] = influence[(place)k * width + l];
        }
}

// Keeps the real part of the transform of an influence, for the frequencies up to half of each axis.
__global__ void take_spectrum(const state* buffer, state* spectrum, int rows, int half) {
    for (int k = blockIdx.x; k <= rows / 2; k += gridDim.x)
        for (int l = threadIdx.x; l < half; l += blockDim.x)
            spectrum[(place)k * half + l] = buffer[2 * ((place)k * half + l)];
}

// Means of 2 × 2 cells, of which those at the end of an odd number count twice. `first` and `length` are those of the
// fine rows that begin in a coarse row; the second fine row is at `second`.
__global__ void coarse_means(const state* fine, state* coarse, const place* first, const place* second, const int* length,
                             const place* to, int rows) {
    for (int row = blockIdx.x; row < rows; row += gridDim.x)
        for (int j = threadIdx.x; j < (length[row] + 1) / 2; j += blockDim.x) {
            const int l = 2 * j, m = l + 1 < length[row] ? l + 1 : l;
            const state *a = fine + first[row], *b = fine + second[row];
            const double sum = ((double)a[l] + (double)a[m]) + ((double)b[l] + (double)b[m]);
            coarse[to[row] + j] = 0.25 * sum;
        }
}

// Copies each value of a coarse field to the cells that it covers.
__global__ void prolong(Contacts f, const state* coarse, const place* from) {
    CELLS f.pressure[c] = coarse[from[row] + j / 2]; END
}

__global__ void statistics(Contacts f, double approach, double* parts) {
    double own[3] = {0, 0, 0};
    CELLS
        const double p = f.pressure[c];
        own[0] += (double)f.touch[c] - approach;
        if (p > 0) own[1] += 1;
        LARGER(own[2], p);
    END
    MERGE(3, 2);
}

__global__ void histogram(Contacts f, double width, int bins, place* counts) {
    CELLS
        const double p = f.pressure[c];
        if (p > 0) {
            const double bin = p / width;
            atomicAdd(counts + (bin < bins ? (int)bin : bins - 1), (place)1);
        }
    END
}

// Gap between the largest height in the buffer and a plane.
__global__ void gap_below(Contacts f, const state* buffer, double summit) {
    CELLS f.gap[c] = summit - (double)buffer[b]; END
}

// Waves of a rough surface.
struct Waves {
    double first; // wavenumber of the first wave along x and y
    double longest, shortest; // wavenumbers of the longest wave of the power law, and of the shortest wave
    double power; // the amplitude is proportional to the wavenumber to this power
    place seed;
};

// A number from the bits of another, by the finaliser of splitmix64.
__device__ place mixed(place x) {
    x += 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

// The amplitude of a wave with `k` periods along x and `l` ≥ 0 along y, without factor.
__device__ void amplitude(const Waves& w, long long k, long long l, double* re, double* im) {
    const double q = w.first * sqrt((double)k * (double)k + (double)l * (double)l);
    *re = *im = 0;
    if (q == 0 || q > w.shortest) return;
    // One of a pair of waves with opposite signs is drawn.
    const double sign = l == 0 && k < 0 ? -1 : 1;
    const place at = mixed(mixed(w.seed) ^ (((place)(sign * k + 2147483648.0) << 32) | (place)l));
    const double u = ((at >> 11) + 0.5) / 9007199254740992.0, v = (mixed(at) >> 11) / 9007199254740992.0;
    const double size = sqrt(-2 * log(u)) * pow(q > w.longest ? q : w.longest, w.power);
    *re = size * cospi(2 * v);
    *im = sign * size * sinpi(2 * v);
}

// Adds the squared slopes of all waves.
__global__ void wave_sums(Waves w, int side, double* parts) {
    double own[1] = {0};
    const int half = side / 2 + 1;
    for (int i = blockIdx.x; i < side; i += gridDim.x) {
        const long long k = 2 * i < side ? i : i - side;
        if (w.first * fabs((double)k) > w.shortest) continue;
        for (int l = threadIdx.x; l < half; l += blockDim.x) {
            double re, im;
            amplitude(w, k, l, &re, &im);
            const double q2 = w.first * w.first * ((double)k * k + (double)l * l);
            own[0] += (l == 0 ? 1 : 2) * q2 * (re * re + im * im);
        }
    }
    MERGE(1, 1);
}

__global__ void set_waves(state* buffer, Waves w, int side, double factor) {
    const int half = side / 2 + 1;
    for (int i = blockIdx.x; i < side; i += gridDim.x) {
        const long long k = 2 * i < side ? i : i - side;
        for (int l = threadIdx.x; l < half; l += blockDim.x) {
            double re, im;
            amplitude(w, k, l, &re, &im);
            state* value = buffer + 2 * ((place)i * half + l);
            value[0] = factor * re;
            value[1] = factor * im;
        }
    }
}

// The largest height in the buffer.
__global__ void summit(const state* buffer, int side, int stride, double* parts) {
    double own[1] = {LEAST};
    for (int i = blockIdx.x; i < side; i += gridDim.x)
        for (int j = threadIdx.x; j < side; j += blockDim.x) LARGER(own[0], buffer[(place)i * stride + j]);
    MERGE(1, 0);
}
}
