using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Threading;
using AgentServer.Unity;
using AgentServer.Unity.EditorTools;
using UnityEngine;

/// The sample room on the stand-in of the engine, in real time, with a real server: it prints what happens
/// and ends after the first command that it has carried out. Its arguments are the server's address and the
/// files into which it records telemetry and skeletons.
static class Program
{
    const float Frame = 0.02f;
    const double Limit = 60;

    static int Main(string[] arguments)
    {
        GameObject top = SampleRoomBuilder.Build();
        var client = top.GetComponent<AgentClient>();
        client.Server.Address = arguments[0];
        int poses = 0, forecasts = 0;
        AgentServer.CommandMessage last = null;
        client.PoseReceived += pose => poses++;
        client.ForecastReceived += forecast => forecasts++;
        client.CommandReceived += command =>
        {
            last = command;
            Console.WriteLine("command " + command.Reaction);
        };
        Lifecycle.Start();
        var recorder = new SessionRecorder(new StreamWriter(arguments[1]), new StreamWriter(arguments[2]));
        client.Monitor.Connection.Received += recorder.Take;
        var watch = Stopwatch.StartNew();
        while (watch.Elapsed.TotalSeconds < Limit)
        {
            Lifecycle.Frames(1, Frame);
            AgentServer.AckMessage word = last == null ? null : client.Renderer.Ledger.LastWord(last.Id);
            if (word != null && word.Status == AgentServer.AckStatus.Done) break;
            Thread.Sleep((int)(Frame * 1000));
        }
        Console.WriteLine("room " + top.GetComponent<Room>().Mode);
        Console.WriteLine("poses " + poses + ", forecasts " + forecasts);
        Console.WriteLine("person " + (top.GetComponentsInChildren<HumanoidRetargeter>(true).Single().IsShowing ? "shown" : "missing"));
        AgentServer.AckMessage end = last == null ? null : client.Renderer.Ledger.LastWord(last.Id);
        Console.WriteLine("last word " + (end == null ? "none" : end.Status.ToString()));
        Lifecycle.Send("OnApplicationQuit");
        recorder.Dispose();
        foreach (string line in UnityEngine.Debug.Lines) Console.WriteLine(line);
        return end != null && end.Status == AgentServer.AckStatus.Done ? 0 : 1;
    }
}
