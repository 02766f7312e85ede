//! Estimators, held to what others compute.

mod estimators;
