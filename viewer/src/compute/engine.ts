// The worker as a function: requests in, answers out, one after the other; and an end to what takes too long.
import type { Answer, Request, Start } from "./messages";
import ComputeWorker from "./worker?worker&inline";

async function moduleOf(): Promise<Start> {
  const script = document.getElementById("gaussmap-script"), code = document.getElementById("gaussmap-code");
  if (!script || !code) throw new Error("this page was built without its program; make wasm builds it");
  const bytes = Uint8Array.from(atob(code.textContent!), (c) => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return { script: JSON.parse(script.textContent!) as string, code: await new Response(plain).arrayBuffer() };
}

export class Cancelled extends Error {}

export class Engine {
  private worker: Worker | null = null;
  private last = 0;
  private waiting = new Map<number, { done: (answer: Answer) => void; failed: (reason: Error) => void }>();
  private module = moduleOf();

  /** \throws Cancelled, or an Error with the complaint of the verb. */
  async ask(request: Omit<Request, "id">): Promise<Answer> {
    const worker = (this.worker ??= await this.started());
    const id = ++this.last;
    const answer = await new Promise<Answer>((done, failed) => {
      this.waiting.set(id, { done, failed });
      worker.postMessage({ ...request, id } satisfies Request);
    });
    if (answer.code !== 0) throw new Error(answer.complaint.replace(/^gaussmap: /, ""));
    return answer;
  }

  /** End what runs. Files of the worker are gone with it. */
  cancel(): void {
    this.worker?.terminate();
    this.worker = null;
    for (const { failed } of this.waiting.values()) failed(new Cancelled("cancelled"));
    this.waiting.clear();
  }

  private async started(): Promise<Worker> {
    const start = await this.module, worker = new ComputeWorker();
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.waiting.get(data.id)?.done(data);
      this.waiting.delete(data.id);
    };
    worker.onerror = (event) => {
      for (const { failed } of this.waiting.values()) failed(new Error(event.message));
      this.waiting.clear();
    };
    worker.postMessage(start);
    return worker;
  }
}
