//! Tests of the depth cameras: conversion, registration, streams, threads, and the Kinect V2.

mod pixels;
