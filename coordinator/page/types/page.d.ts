// What the modules share: the answers of the interface by the names that the page gives them, and the events of its
// elements. The names are ambient, so that a module needs no import for a type.

type Schemas = import("./api").components["schemas"];
type Operations = import("./api").operations;

/** The answer of an operation of the interface. */
type Answer<Name extends keyof Operations> = Operations[Name] extends {
  responses: { 200: { content: { "application/json": infer Body } } };
}
  ? Body
  : never;

/** A path of the interface; the type of its answer is that of a property which no path has. */
type Path<Body> = string & { readonly answer?: Body };

/** The paths that the page asks. */
interface Paths {
  studies: Path<ListedStudy[]>;
  allStudies: Path<ListedStudy[]>;
  workers: Path<Record<string, FarmWorker>>;
  examples: Path<Answer<"list_examples">>;
  effects: Path<Effect[]>;
  library: Path<Answer<"list_library">>;
  experiment(id: number): Path<Answer<"get_experiment">>;
  study(id: number): Path<Study>;
  calibration(id: number): Path<Answer<"get_calibration">>;
  comparison(id: number): Path<Comparison>;
  diagnostics(id: number): Path<Diagnostics>;
  figures(id: number): Path<Figures>;
  provenance(id: number): Path<Answer<"get_provenance">>;
  responseSurface(id: number): Path<Answer<"get_response_surface">>;
  predictionGrid(id: number): Path<Answer<"get_prediction_grid">>;
  decision(id: number): Path<Answer<"get_decision">>;
  campaign(id: number): Path<Followed>;
  job(id: number): Path<Answer<"get_job">>;
  histories(id: number): Path<Answer<"get_histories">>;
  discovery(id: number): Path<Discovery>;
  stages(id: number): Path<Stage[]>;
  events(id: number): Path<never>;
  posterior(id: number): Path<Answer<"get_posterior">>;
  samples(id: number, stage: number, max?: number): Path<Population>;
}

type Channel = "drawbar_pull" | "torque" | "sinkage" | "lateral_force";
/** The runs that are fitted, or those that are held out. */
type Use = "fit" | "holdout";
/** The interface describes channel and use as texts of any kind. */
type ChannelFailure = Schemas["ChannelFailure"] & { channel: Channel; use: Use };

type PointEstimate = Schemas["PointEstimate"];

type Study = Omit<Schemas["StudyOverview"], "members"> & { members: Member[] };
type ListedStudy = Schemas["StudyListItem"];
/** A calibration of a study, a fit or a search; those that are models have a story when they are finished. */
type Member = Schemas["StudyMember"] & { story?: Story | null };
/** A model whose story is told. */
type ToldModel = Member & { story: Story };
type Story = Omit<Schemas["Story"], "wrong"> & { wrong: { channels: ChannelFailure[]; text: string } };
type Flag = Schemas["StudyFlag"];
/** A line of the error ledger of a study. */
type LedgerEntry = Schemas["CalibrationSummary"];
type ErrorTable = Schemas["ErrorTable"];
/** The errors on the held-out runs of a group. */
type HoldoutGroup = Schemas["HoldoutSummary"];
type Comparison = Schemas["Comparison"];
/** A measured value of a channel of a run, beside what the model computes. */
type MeasuredRow = Schemas["ComparisonRow"];
/** A condition of a run, and the axis of a picture that it runs along; scale: from SI to the unit. */
type ConditionKey = "slip" | "wheel_load_n" | "sled_speed_m_s" | "slip_angle_deg";
interface ConditionAxis<Key extends string = ConditionKey> {
  key: Key;
  title: string;
  short: string;
  unit: string;
  scale: number;
}
/** A row with its place in the order in which the runs were made. */
type PlacedRow = MeasuredRow & { place: number };
type ModelComparison = Schemas["ModelComparison"];
type ComparedModel = Schemas["ComparedModel"];
type Diagnostics = Schemas["Diagnostics"];
type Figures = Schemas["CalibrationFigures"];
/** The marginal posterior of a parameter, with its name and unit. */
type Marginal = Schemas["MarginalDensity"] & Schemas["AxisParameter"];
type JointPosterior = Schemas["JointPosterior"];
type ChannelHistory = Schemas["ChannelHistory"];
type Discovery = Schemas["Discovery"];
type JudgedEffect = Schemas["JudgedEffect"];
type Outside = Schemas["Outside"];
type NextRun = Schemas["NextRun"];
type NextStep = Schemas["NextStep"];
type Trend = Schemas["TrendDiagnostics"];
type Effect = Schemas["EffectCard"];
type Followed = Schemas["Followed"];
type CalibrationStatus = Schemas["CalibrationStatus"];
type CalibrationState = Schemas["CalibrationState"];
type Progress = Schemas["Progress"];
type Stage = Schemas["StageRow"];
type Population = Schemas["Population"];
type Sample = Schemas["Sample"];
type FarmWorker = Schemas["WorkerRecord"];
type Guess = Schemas["Guess"];
type FieldGuess = Schemas["FieldGuess"];
type QuantityGuess = Schemas["QuantityGuess"];
type ColumnCard = Schemas["ColumnCard"];
type Complaint = Schemas["Complaint"];
type Converted = Schemas["Converted"];

/** What the events of a calibration tell: its state, or a stage that ended. */
type CalibrationEvent = [name: "status", data: CalibrationStatus] | [name: "stage", data: Stage];

/** An event of an element that its own listener hears. */
type FieldEvent<Field extends Element = HTMLInputElement> = Event & { currentTarget: Field };
type SelectEvent = FieldEvent<HTMLSelectElement>;
type DetailsEvent = FieldEvent<HTMLDetailsElement>;

/** A picture of Plot without a figure around it, with the scales of its axes. */
type Picture = SVGSVGElement & {
  scale(name: string): { range: number[]; apply(value: number): number; invert(place: number): number };
};

/** A JSON schema, as far as the page shows it. */
interface JsonSchema {
  $ref?: string;
  description?: string;
  type?: string | string[];
  const?: unknown;
  enum?: unknown[];
  minimum?: number;
  items?: JsonSchema;
  properties?: Record<string, JsonSchema>;
  additionalProperties?: JsonSchema;
  required?: string[];
  oneOf?: JsonSchema[];
  anyOf?: JsonSchema[];
  allOf?: JsonSchema[];
}

/** What openapi.json says of a body. */
interface JsonContent {
  "application/json"?: { schema?: JsonSchema; example?: unknown };
  [mediaType: string]: { schema?: JsonSchema; example?: unknown } | undefined;
}

/** What openapi.json says of an operation. */
interface JsonOperation {
  operationId: string;
  tags: string[];
  summary: string;
  description: string;
  parameters?: JsonParameter[];
  requestBody?: { content: JsonContent };
  responses: Record<string, JsonResponse>;
}
interface JsonParameter {
  name: string;
  in: string;
  required?: boolean;
  description?: string;
  schema: JsonSchema;
  example?: unknown;
}
interface JsonResponse {
  description: string;
  content?: JsonContent;
}

/** What openapi.json says, as far as the page shows it. */
interface OpenApi {
  info: { title: string; version: string; description: string };
  tags: { name: string; description: string }[];
  paths: Record<string, Record<string, JsonOperation>>;
  components: { schemas: Record<string, JsonSchema> };
}
