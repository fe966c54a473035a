// Least processor time per call of Pinocchio in C++: case, tab, nanoseconds. Arguments: a name and the file of a saved model, by turns.

#include <pinocchio/multibody.hpp>
#include <pinocchio/serialization.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>

static double spent() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * double(now.tv_sec) + double(now.tv_nsec);
}

template <class Call>
static void least(const char *algorithm, const std::string &name, Call call) {
    double best = 1e300;
    for (int round = 0; round < 200; ++round) {
        const double start = spent();
        for (int k = 0; k < 1000; ++k) call();
        best = std::min(best, (spent() - start) / 1000);
    }
    std::printf("%s %s\t%f\n", algorithm, name.c_str(), best);
}

int main(int count, char **arguments) {
    using namespace pinocchio;
    for (int k = 1; k + 1 < count; k += 2) {
        Model model;
        model.loadFromText(arguments[k + 1]);
        Data data(model);
        const std::string name = arguments[k];
        Eigen::VectorXd q = neutral(model), ones = Eigen::VectorXd::Ones(model.nv);
        q.tail(model.nq - 7).setConstant(0.3);
        // what is read cannot be left out
        volatile double read;
        least("rnea", name, [&] { read = rnea(model, data, q, ones, ones)[0]; });
        least("aba", name, [&] { read = aba(model, data, q, ones, ones, Convention::LOCAL)[0]; });
        least("crba", name, [&] { read = crba(model, data, q, Convention::LOCAL)(0, 0); });
        least("drnea", name, [&] { computeRNEADerivatives(model, data, q, ones, ones); read = data.dtau_dq(0, 0); });
        (void)read;
    }
}
