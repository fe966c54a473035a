//! KINSOL and IDA behind the vocabulary of problem.
