//! Tests of the depth cameras: conversion, registration, streams, threads, and the Kinect V2.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests")]

mod fixtures;
mod folders;
mod kinect2;
mod kinect2_model;
mod kinect2_usb;
mod monitor;
mod pixels;
mod registration;
mod streams;
mod threads;
